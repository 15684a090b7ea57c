//! The names of the files of a hemisphere.

/// The endings of FreeSurfer's files, in the order in which they are written.
pub const FREESURFER: [&str; 9] = [
    "sphere",
    "inflated",
    "sulc",
    "cortex.patch.flat",
    "cortex.label",
    "sphere.areal",
    "sphere.shape",
    "flat.areal",
    "flat.shape",
];
/// The endings of the files in GIFTI.
pub const GIFTI: [&str; 6] = [
    "sphere.surf.gii",
    "inflated.surf.gii",
    "flat.surf.gii",
    "sulc.shape.gii",
    "distortion.shape.gii",
    "cortex.label.gii",
];
/// The ending of the picture.
pub const PICTURE: &str = "png";
