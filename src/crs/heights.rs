//! What the heights of a system are counted from.

use super::wkt_read::{METADATA, VERTICAL};
use super::wkt_tree::Node;
use super::{Crs, CrsKind, registry};

/// What the heights of a [`Crs`] are counted from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Heights {
    /// The system has none.
    None,
    /// The ellipsoid of the system in plan.
    Ellipsoid,
    /// The datum of the vertical system with this EPSG code.
    Vertical(u32),
    /// A vertical datum that only the WKT of the system names.
    Named,
    /// It is not stated; only the unit of heights is.
    Unknown,
}

impl Crs {
    /// Returns what heights in this system are counted from.
    pub fn heights(&self) -> Heights {
        if self.kind == CrsKind::Geocentric {
            return Heights::Ellipsoid;
        }
        if let Some(code) = self.vertical_epsg {
            // The text may define what the registry does not have.
            return match (registry::find_vertical(code), &self.wkt) {
                (None, Some(_)) => Heights::Named,
                (None, None) => Heights::Unknown,
                (Some(_), _) => Heights::Vertical(code),
            };
        }
        if self.vertical_unit.is_none() {
            return Heights::None;
        }
        if let Some(wkt) = &self.wkt {
            return match Node::parse_all(wkt) {
                Ok(nodes) if nodes.iter().any(is_above_ellipsoid) => Heights::Ellipsoid,
                Ok(nodes) if nodes.iter().any(|node| vertical(node).is_some()) => Heights::Named,
                _ => Heights::Unknown,
            };
        }
        // A system with three axes has one code for all of them.
        let found = self.epsg.and_then(registry::find);
        match found.and_then(|found| found.vertical) {
            Some(part) if part.code.is_none() => Heights::Ellipsoid,
            _ => Heights::Unknown,
        }
    }

    /// Returns the system with heights above its ellipsoid, in meters; a system that has heights
    /// already is returned as it is.
    pub(super) fn with_ellipsoidal_heights(mut self) -> Self {
        if self.vertical_unit.is_some() {
            return self;
        }
        self.vertical_unit = Some(super::Unit::metre());
        self.wkt = Some(super::wkt_write::write_above_ellipsoid(
            &format!("{} + ellipsoidal height", self.name),
            &self.to_wkt(),
        ));
        self.name += " + ellipsoidal height";
        self
    }

    /// Returns the epoch of the coordinates that the WKT of the system states, in years.
    pub fn epoch(&self) -> Option<f64> {
        let nodes = Node::parse_all(self.wkt.as_deref()?).ok()?;
        let metadata = nodes.iter().find(|node| node.keyword == METADATA)?;
        metadata
            .find(&["EPOCH"])?
            .number(0)
            .filter(|epoch| epoch.is_finite())
    }

    /// Returns true if the authority states latitude or northing first; `None` if that is not
    /// known. Coordinates here are easting or longitude first in any case.
    pub fn is_northing_first(&self) -> Option<bool> {
        registry::is_northing_first(self.epsg?)
    }
}

/// Returns the first vertical system in a text.
fn vertical(node: &Node) -> Option<&Node> {
    if VERTICAL.contains(&node.keyword.as_str()) {
        return Some(node);
    }
    node.nodes().find_map(vertical)
}

/// Returns true if a text states heights above the ellipsoid: by three axes of one system, by a
/// vertical datum that is the ellipsoid (GDAL), or by a vertical system with a datum in plan
/// (Esri).
fn is_above_ellipsoid(node: &Node) -> bool {
    match vertical(node) {
        Some(vertical) => {
            let datum = vertical.find(&["VERT_DATUM", "VDATUM", "VERTICALDATUM", "VRF", "DATUM"]);
            datum.is_some_and(|datum| {
                datum.keyword == "DATUM"
                    || datum.number(0) == Some(2002.0)
                    || datum.name().to_ascii_lowercase().contains("ellipsoid")
            })
        }
        None => has_three_axes(node),
    }
}

fn has_three_axes(node: &Node) -> bool {
    let axes = node.nodes().filter(|child| child.keyword == "AXIS").count();
    let is_base = |child: &Node| child.keyword.starts_with("BASE");
    axes == 3
        || node
            .nodes()
            .any(|child| !is_base(child) && has_three_axes(child))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_heights_are_counted_from() {
        let of = |text: &str| Crs::from_user(text).unwrap().heights();
        assert_eq!(of("EPSG:25832"), Heights::None);
        assert_eq!(of("EPSG:25832+7837"), Heights::Vertical(7837));
        assert_eq!(of("EPSG:4979"), Heights::Ellipsoid);
        assert_eq!(of("EPSG:4978"), Heights::Ellipsoid);
        assert_eq!(of("EPSG:4326"), Heights::None);
        let plan = Crs::from_epsg(25832).unwrap().to_wkt();
        let with = |vertical: &str| of(&format!("COMPD_CS[\"both\",{plan},{vertical}]"));
        let axis = "UNIT[\"metre\",1],AXIS[\"Up\",UP]";
        assert_eq!(
            with(&format!(
                "VERT_CS[\"e\",VERT_DATUM[\"Ellipsoid\",2002],{axis}]"
            )),
            Heights::Ellipsoid
        );
        assert_eq!(
            with(&format!(
                "VERT_CS[\"of nobody\",VERT_DATUM[\"of nobody\",2005],{axis}]"
            )),
            Heights::Named
        );
        assert_eq!(
            of(&format!(
                "{plan},VERTCS[\"WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],\
                 PARAMETER[\"Vertical_Shift\",0.0],PARAMETER[\"Direction\",1.0],UNIT[\"Meter\",1.0]]"
            )),
            Heights::Ellipsoid
        );
    }

    #[test]
    fn a_system_in_plan_can_have_heights_above_its_ellipsoid() {
        let both = Crs::from_user("EPSG:25832+ellipsoid").unwrap();
        assert_eq!(both.heights(), Heights::Ellipsoid);
        assert_eq!((both.epsg, both.vertical_epsg), (Some(25832), None));
        let again = Crs::from_wkt(&both.to_wkt()).unwrap();
        assert_eq!(again.heights(), Heights::Ellipsoid);
        assert!(again.is_same(&both));
        let physical = Crs::from_user("EPSG:25832+7837").unwrap();
        assert!(!both.is_same(&physical) && !physical.is_same(&both));
        assert!(
            both.is_same(&Crs::from_epsg(25832).unwrap()),
            "one does not say"
        );
        assert!(
            Crs::from_user("EPSG:4979+ellipsoid").is_err(),
            "it has heights"
        );
    }

    #[test]
    fn the_epoch_is_that_of_the_text() {
        let plan = Crs::from_epsg(25832).unwrap().to_wkt();
        let stated = Crs::from_wkt(&format!("COORDINATEMETADATA[{plan},EPOCH[2021.5]]")).unwrap();
        assert_eq!((stated.epsg, stated.epoch()), (Some(25832), Some(2021.5)));
        assert_eq!(Crs::from_wkt(&plan).unwrap().epoch(), None);
    }
}
