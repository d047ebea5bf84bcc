//! What is known of an operation between two systems.

/// An operation between two systems.
#[derive(Debug, Clone, PartialEq)]
pub struct OperationFacts {
    /// The name in PROJ's database.
    pub name: String,
    /// The code, such as `EPSG:1149`; several operations after each other have none.
    pub code: Option<String>,
    /// The accuracy in meters, if it is known.
    pub accuracy: Option<f64>,
    /// Where it is meant to be used.
    pub area: Option<OperationArea>,
    /// The grids that it needs.
    pub grids: Vec<OperationGrid>,
    /// It ignores a difference of datums.
    pub is_ballpark: bool,
    /// It transforms heights, too.
    pub has_heights: bool,
    /// It depends on the epoch of the coordinates.
    pub needs_epoch: bool,
    /// It is used: at the point, if one was asked for; else inside of its area.
    pub is_used: bool,
    /// Its steps, as PROJ writes them.
    pub steps: Vec<String>,
}

/// Where an operation is meant to be used, in degrees.
#[derive(Debug, Clone, PartialEq)]
pub struct OperationArea {
    /// The name of the area.
    pub name: String,
    /// The longitude in the west; more than `east` if the area crosses the antimeridian.
    pub west: f64,
    /// The latitude in the south.
    pub south: f64,
    /// The longitude in the east.
    pub east: f64,
    /// The latitude in the north.
    pub north: f64,
}

/// A grid that an operation needs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OperationGrid {
    /// The name of the file.
    pub name: String,
    /// Where it can be downloaded, if PROJ knows that.
    pub url: Option<String>,
    /// The file that was found, maybe by the name of an older format.
    pub file: Option<String>,
    /// Its state.
    pub state: GridState,
}

/// The state of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GridState {
    /// It is installed.
    Installed,
    /// It is not installed.
    Missing,
    /// It is installed, but this build cannot read its format.
    Unreadable,
}

impl OperationFacts {
    /// Returns the grids that cannot be used.
    pub fn missing(&self) -> impl Iterator<Item = &OperationGrid> {
        self.grids
            .iter()
            .filter(|grid| grid.state != GridState::Installed)
    }

    /// Returns true if all grids that it needs are installed.
    pub fn is_usable(&self) -> bool {
        self.missing().next().is_none()
    }

    /// Returns true if it is meant for a longitude and latitude; also if its area, or the position,
    /// is not known.
    pub fn covers(&self, position: Option<[f64; 2]>) -> bool {
        match (&self.area, position) {
            (Some(area), Some(position)) => area.contains(position),
            _ => true,
        }
    }
}

impl OperationArea {
    /// Returns true if a longitude and latitude lie in the area.
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let in_longitude = if self.west <= self.east {
            (self.west..=self.east).contains(&x)
        } else {
            x >= self.west || x <= self.east
        };
        in_longitude && (self.south..=self.north).contains(&y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_area_may_cross_the_antimeridian() {
        let area = |west, east| OperationArea {
            name: "somewhere".to_owned(),
            west,
            south: -10.0,
            east,
            north: 10.0,
        };
        assert!(area(5.0, 15.0).contains([9.0, 10.0]));
        assert!(!area(5.0, 15.0).contains([9.0, 11.0]));
        assert!(!area(5.0, 15.0).contains([-9.0, 0.0]));
        assert!(area(170.0, -170.0).contains([175.0, 0.0]));
        assert!(area(170.0, -170.0).contains([-175.0, 0.0]));
        assert!(!area(170.0, -170.0).contains([0.0, 0.0]));
    }
}
