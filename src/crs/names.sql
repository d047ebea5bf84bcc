-- Makes names.txt, the names that the proj-core registry does not carry, from PROJ's database:
--   sqlite3 proj.db < src/crs/names.sql > src/crs/names.txt      (proj.db of PROJ 9.6.2: EPSG 12.013)
-- Lines, by kind, each sorted by code:
--   d|datum|name|ESRI name|ellipsoid|prime meridian     e|ellipsoid|name|ESRI name
--   g|geographic system|ESRI name|datum                 p|projected system|ESRI name
--   v|vertical system|name|datum|datum name             n|projected system without a formula in proj-core|metres in a unit|name
.mode list
.separator |
CREATE TEMP VIEW esri AS
  SELECT table_name, code, min(alt_name) AS name FROM alias_name
  WHERE auth_name = 'EPSG' AND source = 'ESRI' GROUP BY table_name, code;
SELECT 'd', d.code, d.name, coalesce(e.name, ''), d.ellipsoid_code, d.prime_meridian_code FROM geodetic_datum d
  LEFT JOIN esri e ON e.table_name = 'geodetic_datum' AND e.code = d.code
  WHERE d.auth_name = 'EPSG' ORDER BY d.code;
SELECT 'e', l.code, l.name, coalesce(e.name, '') FROM ellipsoid l
  LEFT JOIN esri e ON e.table_name = 'ellipsoid' AND e.code = l.code
  WHERE l.auth_name = 'EPSG' ORDER BY l.code;
SELECT 'g', g.code, coalesce(e.name, ''), g.datum_code FROM geodetic_crs g
  LEFT JOIN esri e ON e.table_name = 'geodetic_crs' AND e.code = g.code
  WHERE g.auth_name = 'EPSG' AND g.type = 'geographic 2D' ORDER BY g.code;
SELECT 'p', c.code, e.name FROM projected_crs c
  JOIN esri e ON e.table_name = 'projected_crs' AND e.code = c.code
  WHERE c.auth_name = 'EPSG' ORDER BY c.code;
SELECT 'v', c.code, c.name, c.datum_code, d.name FROM vertical_crs c
  JOIN vertical_datum d ON d.auth_name = c.datum_auth_name AND d.code = c.datum_code
  WHERE c.auth_name = 'EPSG' ORDER BY c.code;
SELECT DISTINCT 'n', c.code, u.conv_factor, c.name FROM projected_crs c
  JOIN conversion k ON k.auth_name = c.conversion_auth_name AND k.code = c.conversion_code
  JOIN axis a ON a.auth_name = c.coordinate_system_auth_name AND a.coordinate_system_code = c.coordinate_system_code
  JOIN unit_of_measure u ON u.auth_name = a.uom_auth_name AND u.code = a.uom_code
  WHERE c.auth_name = 'EPSG' AND a.coordinate_system_order = 1
    AND (c.deprecated OR k.method_name IN ('Transverse Mercator (South Orientated)', 'Lambert Conic Conformal (West Orientated)',
      'Krovak', 'Krovak Modified', 'Bonne (South Orientated)', 'Tunisia Mining Grid', 'Transverse Mercator 3D', 'New Zealand Map Grid',
      'Lambert Cylindrical Equal Area', 'Lambert Conic Near-Conformal', 'Lambert Conic Conformal (2SP Belgium)', 'Hyperbolic Cassini-Soldner'))
  ORDER BY c.code;
