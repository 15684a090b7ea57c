//! The options with which a scene is written, and what is said of it then.

/// The options of [`super::SceneFile::write`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SceneOptions {
    /// The set of texture coordinates that is written, TEXCOORD_n, from 0 to 7. `None`: 0 if no texture of the file uses it, else the first
    /// set that no texture uses and no mesh has, so that textures stay where they are. Default `None`.
    pub texcoord: Option<u32>,
    /// True to write tangents of the coordinates, [`crate::mesh::tangents`], where there are normals and the normal map uses the same set.
    /// Default false.
    pub tangents: bool,
}

/// What was written.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SceneReport {
    /// The set of texture coordinates that was written.
    pub texcoord: u32,
    /// The primitives that have them.
    pub n_primitives: usize,
    /// The vertices of these primitives in the file that was read.
    pub n_vertices: usize,
    /// Their vertices in the file that was written.
    pub n_split_vertices: usize,
    /// The primitives that had coordinates in this set, which are gone.
    pub n_replaced: usize,
    /// The textures of materials that use other sets, which are as they were.
    pub n_kept_textures: usize,
    /// The textures that use this set, whose pictures no longer fit: 0 unless the set was asked for.
    pub n_misplaced_textures: usize,
    /// The primitives with tangents of these coordinates.
    pub n_tangents: usize,
    /// The primitives without, though tangents were asked for: without normals, or with a normal map on another set.
    pub n_without_tangents: usize,
    /// The primitives whose tangents were left out because they were those of coordinates that were replaced.
    pub n_dropped_tangents: usize,
    /// The strips and fans that became lists of triangles.
    pub n_unrolled: usize,
    /// The meshes that several nodes show, with one set of charts.
    pub n_shared_meshes: usize,
    /// What else is not as it was, in words.
    pub notes: Vec<String>,
}
