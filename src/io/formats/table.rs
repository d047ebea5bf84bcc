//! The table of formats. Most rows override a few fields of another row: of [`ROW`], or of one that
//! [`lidar`], [`raster`], [`vector`], [`mesh`] or [`plane`] returns.

use super::format::{
    Content, Format, FormatReader, Holding, KnownBy, Magic, NOT_WRITTEN, PointWriter, Writers,
};
use super::rows::{
    AS_RASTER, DATABASE, PACKED_LIDAR_POINTS, PLANE_OR_SPACE, ROW, SHAPES_AND_CRS,
    SURFACE_AND_LINES, TEXT, UNPACK, layer_writers, lidar, lidar_sink, mesh, plane, raster, space,
    surface_writer, vector,
};
use crate::io::bytes::watch::bytes_of;
use crate::io::codec::geotiff::CellFormat;
use crate::io::codec::las::{Detail, Packing};
use crate::io::codec::listing::Remarks;
use crate::io::codec::{
    ascii_grid, cityjson, dxf, flatgeobuf, geojson, geotiff, glb, gpkg, landxml, mesh2dm, obj, off,
    ply, png, shapefile, stl, text, tin, triangle, ugrid, xyz_grid, zipped,
};

/// All formats, in the order in which lists show them.
pub static FORMATS: &[Format] = &[
    Format {
        help: "lidar points",
        ..lidar(
            "LAS",
            "a LAS file",
            &["las"],
            |target, sources, rounding| lidar_sink(target, sources, rounding, Packing::Plain),
        )
    },
    Format {
        holds: PACKED_LIDAR_POINTS,
        help: "lidar points, compressed, in an octree",
        ..lidar(
            "COPC",
            "a COPC file",
            &["copc.laz"],
            |target, sources, rounding| lidar_sink(target, sources, rounding, Packing::Octree),
        )
    },
    Format {
        holds: PACKED_LIDAR_POINTS,
        help: "lidar points, compressed",
        ..lidar(
            "LAZ",
            "a LAZ file",
            &["laz"],
            |target, sources, rounding| lidar_sink(target, sources, rounding, Packing::Compressed),
        )
    },
    Format {
        name: "text",
        noun: "a text file",
        extensions: &["xyz", "txt", "csv"],
        known_by: KnownBy::Rest,
        holds: &[Holding::Points],
        reader: TEXT,
        writers: Writers {
            points: Some(PointWriter {
                detail: Detail::Columns,
                create: |target, sources, _| Ok(Box::new(text::create(target, sources)?)),
            }),
            ..NOT_WRITTEN
        },
        help: "points, one per line; also read under any other name",
        ..ROW
    },
    Format {
        name: "text, by others",
        noun: "a text file",
        extensions: &["asc", "pts"],
        known_by: KnownBy::Rest,
        holds: &[Holding::Points],
        reader: TEXT,
        help: "points, one a line",
        ..ROW
    },
    Format {
        known_by: KnownBy::Name,
        holds: SHAPES_AND_CRS,
        beside: &["shx", "dbf", "prj", "cpg"],
        parts: &["shx", "dbf", "prj", "cpg", "qpj", "qix", "sbn", "sbx"],
        read_along: &["shx", "dbf", "prj", "cpg"],
        gdal_names: &["ESRI Shapefile"],
        reader: FormatReader::Layer(shapefile::read_layer_with),
        writers: Writers {
            check_size: Some(shapefile::check_size),
            ..layer_writers(
                |target, lines, crs| shapefile::write_contours(target, lines, crs),
                |target, layer| shapefile::write_lines(target, layer),
            )
        },
        help: "lines, polygons and points; contours; draped lines",
        ..vector(
            "shapefile",
            "a shapefile",
            &["shp"],
            // File code 9994, big endian.
            &[Magic::At(0, &[0, 0, 0x27, 0x0a])],
        )
    },
    Format {
        known_by: KnownBy::Name,
        holds: SHAPES_AND_CRS,
        reader: FormatReader::Layers(zipped::read_layer_with),
        cure: UNPACK,
        help: "lines, polygons and points in named shapefiles",
        ..vector(
            "zipped shapefile",
            "a ZIP archive",
            &["zip", "shz"],
            &[Magic::At(0, b"PK\x03\x04")],
        )
    },
    Format {
        holds: SHAPES_AND_CRS,
        gdal_names: &["GeoJSON"],
        reader: FormatReader::Layer(geojson::read_layer_with),
        writers: layer_writers(
            |target, lines, crs| geojson::write_contours(target, lines, crs),
            |target, layer| geojson::write_lines(target, layer),
        ),
        help: "lines, polygons and points; contours; draped lines",
        ..vector(
            "GeoJSON",
            "a JSON file",
            &["geojson", "json"],
            &[Magic::At(0, b"{")],
        )
    },
    Format {
        gdal_names: &["GeoJSONSeq"],
        reader: FormatReader::Layer(geojson::read_lines_with),
        writers: layer_writers(
            |target, lines, crs| geojson::write_contour_lines(target, lines, crs),
            |target, layer| geojson::write_line_records(target, layer),
        ),
        help: "lines, polygons and points; contours; draped lines; one feature a line",
        ..vector(
            "GeoJSON lines",
            "a file of GeoJSON lines",
            &["geojsonl", "geojsons"],
            &[],
        )
    },
    Format {
        known_by: KnownBy::Bytes,
        holds: SHAPES_AND_CRS,
        read_along: &["gpkg-wal"],
        gdal_names: &["GPKG"],
        reader: DATABASE,
        writers: Writers {
            map: Some(gpkg::write_map),
            ..layer_writers(
                |target, lines, crs| gpkg::write_contours(target, lines, crs),
                |target, layer| gpkg::write_lines(target, layer),
            )
        },
        help: "lines, polygons and points in named layers; contours; draped lines",
        ..vector(
            "GeoPackage",
            "a GeoPackage or another SQLite database",
            &["gpkg"],
            &[Magic::At(0, b"SQLite format 3\0")],
        )
    },
    Format {
        known_by: KnownBy::Bytes,
        holds: SHAPES_AND_CRS,
        gdal_names: &["FlatGeobuf"],
        reader: FormatReader::Layer(flatgeobuf::read_layer_with),
        writers: layer_writers(
            |target, lines, crs| flatgeobuf::write_contours(target, lines, crs),
            |target, layer| flatgeobuf::write_lines(target, layer),
        ),
        help: "lines, polygons and points; contours; draped lines; with an index",
        ..vector(
            "FlatGeobuf",
            "a FlatGeobuf file",
            &["fgb"],
            &[Magic::At(0, b"fgb\x03fgb")],
        )
    },
    Format {
        name: "GeoTIFF",
        noun: "a TIFF file",
        extensions: &["tif", "tiff"],
        // TIFF and BigTIFF, in both byte orders.
        magic: &[
            Magic::At(0, b"II*\0"),
            Magic::At(0, b"MM\0*"),
            Magic::At(0, b"II+\0"),
            Magic::At(0, b"MM\0+"),
        ],
        known_by: KnownBy::Bytes,
        content: Content::Raster,
        holds: &[Holding::Raster, Holding::Crs, Holding::Compression],
        read_along: &["tfw", "tifw", "tiffw", "wld"],
        gdal_names: &["GTiff", "COG"],
        as_written: geotiff::AS_WRITTEN,
        reader: FormatReader::Raster(|path| geotiff::open(path)),
        writers: Writers {
            heights: Some(|target, source| {
                geotiff::write(target, source, CellFormat::Heights.into())
            }),
            shades: Some(|target, source| {
                geotiff::write(target, source, CellFormat::Shades.into()).map(drop)
            }),
            colors: Some(|target, source, colors| {
                geotiff::write(target, source, CellFormat::Colors(colors).into()).map(drop)
            }),
            ..NOT_WRITTEN
        },
        cure: AS_RASTER,
        help: "heights in cells; hillshade; color relief",
        ..ROW
    },
    Format {
        known_by: KnownBy::NameAndBytes,
        holds: &[Holding::Raster, Holding::Crs],
        beside: &["prj"],
        parts: &["prj"],
        read_along: &["prj"],
        gdal_names: &["AAIGrid"],
        reader: FormatReader::Grid(|path| ascii_grid::open(path)),
        writers: Writers {
            heights: Some(ascii_grid::write),
            ..NOT_WRITTEN
        },
        help: "heights in cells, as text",
        ..raster(
            "ESRI ASCII grid",
            "an ESRI ASCII grid",
            &["asc"],
            &[Magic::Word("ncols"), Magic::Word("nrows")],
        )
    },
    Format {
        known_by: KnownBy::NameAndBytes,
        gdal_names: &["XYZ"],
        reader: FormatReader::Unread,
        writers: Writers {
            heights: Some(xyz_grid::write),
            ..NOT_WRITTEN
        },
        ..raster("XYZ grid", "an XYZ grid", &["xyz"], &[])
    },
    Format {
        name: "PNG",
        noun: "a PNG picture",
        extensions: &["png"],
        magic: &[Magic::At(0, b"\x89PNG")],
        content: Content::Picture,
        holds: &[Holding::Raster, Holding::Crs, Holding::Compression],
        beside: &["pgw", "png.aux.xml"],
        parts: &["pgw", "png.aux.xml"],
        read_along: &["pgw", "pngw", "wld", "png.aux.xml"],
        gdal_names: &["PNG"],
        reader: FormatReader::InfoOnly,
        writers: Writers {
            shades: Some(|target, source| png::write_gray(target, source)),
            colors: Some(|target, source, colors| png::write_colors(target, source, colors)),
            ..NOT_WRITTEN
        },
        cure: AS_RASTER,
        help: "hillshade; color relief",
        ..ROW
    },
    Format {
        holds: SURFACE_AND_LINES,
        reader: FormatReader::Mesh(|path, watch| ply::read(&bytes_of(path, watch)?, watch)),
        writers: surface_writer(|target, mesh, crs| {
            ply::write(target, mesh, crs).map(|()| Remarks::default())
        }),
        help: "triangles with breaklines and coordinate system",
        ..mesh("PLY", "a PLY mesh", &["ply"], &[Magic::At(0, b"ply")])
    },
    Format {
        reader: FormatReader::Mesh(|path, watch| obj::read(&bytes_of(path, watch)?, watch)),
        writers: surface_writer(|target, mesh, crs| {
            obj::write(target, mesh, crs).map(|()| Remarks::default())
        }),
        help: "triangles",
        ..mesh("OBJ", "an OBJ mesh", &["obj"], &[])
    },
    Format {
        reader: FormatReader::Mesh(|path, watch| off::read(&bytes_of(path, watch)?, watch)),
        writers: surface_writer(|target, mesh, crs| {
            off::write(target, mesh, crs).map(|()| Remarks::default())
        }),
        help: "triangles",
        ..mesh("OFF", "an OFF mesh", &["off"], &[])
    },
    Format {
        holds: SURFACE_AND_LINES,
        reader: FormatReader::Surfaces(landxml::read),
        writers: surface_writer(landxml::write),
        help: "surfaces with breaklines, boundaries, units and coordinate system; FILE:NAME",
        ..mesh("LandXML", "a LandXML file", &["xml", "landxml"], &[])
    },
    Format {
        reader: FormatReader::Mesh(|path, watch| glb::read(&bytes_of(path, watch)?, watch)),
        writers: surface_writer(glb::write),
        help: "triangles in 32-bit floats from a local origin, with normals and colors (glTF)",
        ..mesh(
            "GLB",
            "a binary glTF file",
            &["glb"],
            &[Magic::At(0, b"glTF")],
        )
    },
    Format {
        holds: &[Holding::Mesh],
        reader: FormatReader::Mesh(|path, watch| mesh2dm::read(&bytes_of(path, watch)?, watch)),
        writers: surface_writer(mesh2dm::write),
        help: "triangles (SMS, MDAL)",
        ..mesh("2DM", "a 2DM mesh", &["2dm"], &[Magic::At(0, b"MESH2D")])
    },
    Format {
        known_by: KnownBy::NameAndBytes,
        reader: FormatReader::Mesh(|path, watch| ugrid::read(&bytes_of(path, watch)?, watch)),
        writers: surface_writer(ugrid::write),
        help: "triangles in NetCDF (MDAL, xarray)",
        ..mesh(
            "UGRID",
            "a UGRID mesh",
            &["nc"],
            &[Magic::At(0, b"CDF\x01"), Magic::At(0, b"CDF\x02")],
        )
    },
    Format {
        reader: FormatReader::Unread,
        writers: surface_writer(cityjson::write),
        ..mesh("CityJSON", "a CityJSON file", &["cityjson"], &[])
    },
    Format {
        holds: &[Holding::Mesh],
        beside: &["stl.origin.txt"],
        parts: &["stl.origin.txt"],
        read_along: &["stl.origin.txt"],
        reader: FormatReader::Solid(stl::describe),
        writers: surface_writer(|target, mesh, _| {
            Ok(Remarks {
                origin: Some(stl::write(target, mesh)?),
                ..Remarks::default()
            })
        }),
        help: "triangles in 32-bit floats from a local origin; written only",
        ..mesh("STL", "an STL mesh", &["stl"], &[])
    },
    Format {
        known_by: KnownBy::Bytes,
        holds: SURFACE_AND_LINES,
        reader: FormatReader::Tin(tin::map),
        writers: surface_writer(|target, mesh, _| {
            tin::write(target, mesh).map(|()| Remarks::default())
        }),
        help: "triangulation with breaklines and coordinate system, opened in milliseconds",
        ..mesh(
            "TIN",
            "a TIN of breakline",
            &["tin"],
            &[Magic::At(0, b"brkTIN\n\x1a")],
        )
    },
    Format {
        known_by: KnownBy::Bytes,
        holds: SURFACE_AND_LINES,
        reader: FormatReader::Parts(tin::index),
        writers: surface_writer(|_, _, _| Err(tin::needs_tiles())),
        help: "index of a TIN in parts, one file for each tile; for surfaces larger than memory",
        ..mesh(
            "TIN in parts",
            "a TIN in parts",
            &["tins"],
            &[Magic::At(0, b"{\"breakline_tin_parts\"")],
        )
    },
    Format {
        reader: FormatReader::Layers(dxf::read),
        writers: Writers {
            surface: Some(dxf::write_surface),
            map: Some(dxf::write_map),
            ..layer_writers(dxf::write_contours, dxf::write_lines)
        },
        holds: &[
            Holding::Points,
            Holding::Lines,
            Holding::Mesh,
            Holding::Edges,
        ],
        gdal_names: &["DXF"],
        help: "drawings: lines and points of a layer; surfaces, contours and draped lines; FILE:LAYER",
        ..vector("DXF", "a DXF drawing", &["dxf"], &[])
    },
    Format {
        reader: FormatReader::Mesh(triangle::read_triangles_with),
        content: Content::Mesh,
        holds: &[Holding::Mesh, Holding::Edges],
        beside: &["node"],
        read_along: &["node", "poly", "edge", "neigh"],
        writers: PLANE_OR_SPACE,
        ..plane(
            "Triangle .ele",
            "an .ele file of Triangle",
            &["ele"],
            "triangles in the plane (Triangle), tetrahedra (TetGen)",
        )
    },
    Format {
        holds: &[Holding::Points],
        writers: PLANE_OR_SPACE,
        ..plane(
            "Triangle .node",
            "a .node file of Triangle",
            &["node"],
            "points (Triangle, TetGen)",
        )
    },
    Format {
        holds: &[Holding::Points, Holding::Lines],
        beside: &["node"],
        read_along: &["node"],
        ..plane(
            "Triangle .poly",
            "a .poly file of Triangle",
            &["poly"],
            "points and segments in the plane (Triangle)",
        )
    },
    Format {
        reader: FormatReader::InfoOnly,
        beside: &["node"],
        writers: PLANE_OR_SPACE,
        ..plane(
            "Triangle .edge",
            "an .edge file of Triangle",
            &["edge"],
            "edges of a triangulation (Triangle, TetGen)",
        )
    },
    Format {
        reader: FormatReader::InfoOnly,
        writers: PLANE_OR_SPACE,
        ..plane(
            "Triangle .neigh",
            "a .neigh file of Triangle",
            &["neigh"],
            "neighbors in a triangulation (Triangle, TetGen)",
        )
    },
    Format {
        holds: &[Holding::Mesh],
        beside: &["node"],
        ..space("TetGen .face", "a .face file of TetGen", &["face"])
    },
    Format {
        holds: &[Holding::Points, Holding::Mesh],
        ..space("MEDIT", "a MEDIT mesh", &["mesh"])
    },
    Format {
        holds: &[Holding::Points],
        ..space("VTU", "an unstructured grid of VTK", &["vtu"])
    },
    // Formats read by GDAL, or only named in messages.
    raster(
        "GDAL virtual raster",
        "a GDAL virtual raster",
        &["vrt"],
        &[Magic::At(0, b"<VRTDataset")],
    ),
    Format {
        gdal_names: &["HFA"],
        ..raster(
            "Erdas Imagine",
            "an Erdas Imagine file",
            &["img"],
            &[Magic::At(0, b"EHFA_HEADER_TAG")],
        )
    },
    Format {
        gdal_names: &["SRTMHGT"],
        ..raster(
            "SRTM height file (HGT)",
            "an SRTM height file",
            &["hgt"],
            &[],
        )
    },
    Format {
        gdal_names: &["USGSDEM"],
        ..raster("USGS DEM", "a USGS DEM", &["dem"], &[])
    },
    Format {
        gdal_names: &["DTED"],
        ..raster(
            "DTED",
            "a DTED file",
            &["dt0", "dt1", "dt2"],
            &[
                Magic::At(0, b"UHL1"),
                Magic::At(0, b"HDR1"),
                Magic::At(80, b"UHL1"),
            ],
        )
    },
    Format {
        gdal_names: &["EHdr"],
        ..raster(
            "raw raster (BIL, FLT)",
            "a raw raster",
            &["bil", "flt"],
            &[],
        )
    },
    raster(
        "Surfer grid",
        "a Surfer grid",
        &[],
        &[
            Magic::At(0, b"DSAA"),
            Magic::At(0, b"DSBB"),
            Magic::At(0, b"DSRB"),
        ],
    ),
    Format {
        known_by: KnownBy::NameAndBytes,
        gdal_names: &["netCDF"],
        ..raster(
            "NetCDF 4 or HDF",
            "an HDF5 or NetCDF 4 file",
            &["nc"],
            &[Magic::At(0, b"\x89HDF")],
        )
    },
    raster("GRIB", "a GRIB file", &[], &[Magic::At(0, b"GRIB")]),
    raster(
        "JPEG",
        "a JPEG picture",
        &[],
        &[Magic::At(0, b"\xff\xd8\xff")],
    ),
    raster(
        "JPEG 2000",
        "a JPEG 2000 picture",
        &[],
        &[Magic::At(4, b"jP  "), Magic::At(0, b"\xff\x4f\xff\x51")],
    ),
    Format {
        gdal_names: &["LIBKML", "KML", "GML"],
        ..vector(
            "XML (GML, KML)",
            "an XML file (GML, KML)",
            &["kml", "gml"],
            &[Magic::At(0, b"<?xml")],
        )
    },
    Format {
        gdal_names: &["OpenFileGDB"],
        ..vector("file geodatabase", "a file geodatabase", &["gdb"], &[])
    },
    vector("DWG", "a DWG drawing", &[], &[Magic::At(0, b"AC10")]),
    Format {
        name: "E57",
        noun: "an E57 scan",
        magic: &[Magic::At(0, b"ASTM-E57")],
        reader: FormatReader::Unread,
        cure: || "save it as LAS or LAZ".into(),
        ..ROW
    },
    Format {
        name: "gzip",
        noun: "a gzip archive",
        magic: &[Magic::At(0, b"\x1f\x8b")],
        reader: FormatReader::Unread,
        cure: UNPACK,
        ..ROW
    },
];
