//! Numbers and names of the TIFF and GeoTIFF tags that are used here.

pub(super) const NEW_SUBFILE_TYPE: u16 = 254;
pub(super) const IMAGE_WIDTH: u16 = 256;
pub(super) const IMAGE_LENGTH: u16 = 257;
pub(super) const BITS_PER_SAMPLE: u16 = 258;
pub(super) const COMPRESSION: u16 = 259;
pub(super) const PHOTOMETRIC: u16 = 262;
pub(super) const FILL_ORDER: u16 = 266;
pub(super) const STRIP_OFFSETS: u16 = 273;
pub(super) const SAMPLES_PER_PIXEL: u16 = 277;
pub(super) const ROWS_PER_STRIP: u16 = 278;
pub(super) const STRIP_BYTE_COUNTS: u16 = 279;
pub(super) const PLANAR_CONFIGURATION: u16 = 284;
pub(super) const PREDICTOR: u16 = 317;
pub(super) const TILE_WIDTH: u16 = 322;
pub(super) const TILE_LENGTH: u16 = 323;
pub(super) const TILE_OFFSETS: u16 = 324;
pub(super) const TILE_BYTE_COUNTS: u16 = 325;
pub(super) const EXTRA_SAMPLES: u16 = 338;
pub(super) const SAMPLE_FORMAT: u16 = 339;
pub(super) const JPEG_TABLES: u16 = 347;
pub(super) const MODEL_PIXEL_SCALE: u16 = 33550;
pub(super) const MODEL_TIEPOINT: u16 = 33922;
pub(super) const MODEL_TRANSFORMATION: u16 = 34264;
pub(super) const GEO_KEY_DIRECTORY: u16 = 34735;
pub(super) const GEO_DOUBLE_PARAMS: u16 = 34736;
pub(super) const GEO_ASCII_PARAMS: u16 = 34737;
pub(super) const GDAL_METADATA: u16 = 42112;
pub(super) const GDAL_NODATA: u16 = 42113;

/// GTRasterTypeGeoKey: 1 is PixelIsArea, 2 PixelIsPoint.
pub(super) const RASTER_TYPE_KEY: u16 = 1025;

pub(super) const COMPRESSION_NONE: u16 = 1;
pub(super) const COMPRESSION_LZW: u16 = 5;
pub(super) const COMPRESSION_JPEG: u16 = 7;
pub(super) const COMPRESSION_DEFLATE: u16 = 8;
pub(super) const COMPRESSION_OLD_DEFLATE: u16 = 32946;
pub(super) const COMPRESSION_PACKBITS: u16 = 32773;
pub(super) const COMPRESSION_ZSTD: u16 = 50000;

/// Returns the name and number of a tag, for messages.
pub(super) fn tag_name(tag: u16) -> String {
    let name = match tag {
        IMAGE_WIDTH => "ImageWidth",
        IMAGE_LENGTH => "ImageLength",
        BITS_PER_SAMPLE => "BitsPerSample",
        COMPRESSION => "Compression",
        STRIP_OFFSETS => "StripOffsets",
        SAMPLES_PER_PIXEL => "SamplesPerPixel",
        ROWS_PER_STRIP => "RowsPerStrip",
        STRIP_BYTE_COUNTS => "StripByteCounts",
        PLANAR_CONFIGURATION => "PlanarConfiguration",
        PREDICTOR => "Predictor",
        TILE_WIDTH => "TileWidth",
        TILE_LENGTH => "TileLength",
        TILE_OFFSETS => "TileOffsets",
        TILE_BYTE_COUNTS => "TileByteCounts",
        SAMPLE_FORMAT => "SampleFormat",
        JPEG_TABLES => "JPEGTables",
        MODEL_PIXEL_SCALE => "ModelPixelScaleTag",
        MODEL_TIEPOINT => "ModelTiepointTag",
        MODEL_TRANSFORMATION => "ModelTransformationTag",
        GEO_KEY_DIRECTORY => "GeoKeyDirectoryTag",
        GEO_DOUBLE_PARAMS => "GeoDoubleParamsTag",
        GEO_ASCII_PARAMS => "GeoAsciiParamsTag",
        GDAL_METADATA => "GDAL_METADATA",
        GDAL_NODATA => "GDAL_NODATA",
        _ => return format!("tag {tag}"),
    };
    format!("tag {name} ({tag})")
}

/// Returns the name of a compression; "of an unknown kind" for unknown codes.
pub(super) fn compression_name(code: u16) -> &'static str {
    match code {
        COMPRESSION_NONE => "none",
        2 => "CCITT RLE",
        3 => "CCITT Group 3",
        4 => "CCITT Group 4",
        COMPRESSION_LZW => "LZW",
        6 => "old-style JPEG",
        COMPRESSION_JPEG => "JPEG",
        COMPRESSION_DEFLATE | COMPRESSION_OLD_DEFLATE => "DEFLATE",
        COMPRESSION_PACKBITS => "PackBits",
        34712 => "JPEG 2000",
        34887 => "LERC",
        34925 => "LZMA",
        COMPRESSION_ZSTD => "ZSTD",
        50001 => "WebP",
        50002 | 52546 => "JPEG XL",
        _ => "of an unknown kind",
    }
}
