//! A glTF file whose scene is kept: its meshes as one triangle list, and the file again with the texture coordinates of that list.

use super::super::surface_file::SurfaceFile;
use super::accessor::GltfFile;
use super::kept_document::KeptDocument;
use super::pictures::embed;
use super::scene_edit::SceneEdit;
use super::scene_model::{SceneModel, model};
use super::scene_report::{SceneOptions, SceneReport};
use super::texture_sets::{MaterialTextures, set_name, textures};
use super::with_file;
use crate::error::{Error, Result, check_size};
use crate::mesh::io::Soup;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The largest number of a set that can be asked for; viewers know fewer.
const LARGEST_SET: u32 = 7;

/// A glTF file with everything that is in it. Its triangles are a list for a job such as a texture atlas, and [`SceneFile::write`] puts the
/// coordinates of that list into the file: nodes, cameras, materials, animations, skins, names and extras stay as they are.
///
/// A mesh is in the list once, however many nodes show it, in the size of the node that enlarges it most; so are meshes that no node
/// shows. Vertices are those of the file, repeated ones too.
///
/// ```no_run
/// use ricci::mesh::io::{SceneFile, SceneOptions};
/// use ricci::texture::{TextureOptions, texture_atlas_of_parts};
/// # fn main() -> ricci::Result<()> {
/// let scene = SceneFile::open("scene.glb".as_ref())?;
/// let (options, control) = (TextureOptions::default(), ricci::Control::new());
/// let atlas = texture_atlas_of_parts(scene.soup(), scene.meshes(), &options, &control)?;
/// scene.write("out.glb".as_ref(), &atlas.corner_uv, &SceneOptions::default())?;
/// # Ok(())
/// # }
/// ```
pub struct SceneFile {
    /// The name in errors.
    name: String,
    folder: Option<PathBuf>,
    bytes: Vec<u8>,
    model: SceneModel,
    nodes: usize,
    materials: usize,
}

impl SceneFile {
    /// Reads a .glb or .gltf file, also packed by gzip.
    ///
    /// # Errors
    /// Those of [`SurfaceFile::open`] and [`super::parse_glb`]; [`Error::UnknownFormat`] for another format.
    pub fn open(path: &Path) -> Result<SceneFile> {
        let (name, folder, bytes) = SurfaceFile::open(path)?.into_gltf()?;
        SceneFile::new(name, folder, bytes)
    }

    /// A file without a name; its buffers are inside it. `name` is used in errors.
    ///
    /// # Errors
    /// As [`SceneFile::open`].
    pub fn of_bytes(bytes: Vec<u8>, name: &str) -> Result<SceneFile> {
        let (name, folder, bytes) = SurfaceFile::of_bytes(bytes, name)?.into_gltf()?;
        SceneFile::new(name, folder, bytes)
    }

    fn new(name: String, folder: Option<PathBuf>, bytes: Vec<u8>) -> Result<SceneFile> {
        let (model, nodes, materials) = with_file(&bytes, &name, folder.as_deref(), |file, budget| {
            let model = model(file, &plain(file)?, budget)?;
            Ok((model, file.document.nodes.len(), file.document.materials.len()))
        })?;
        Ok(SceneFile { name, folder, bytes, model, nodes, materials })
    }

    /// The triangles of all meshes, without attributes.
    pub fn soup(&self) -> &Soup {
        &self.model.soup
    }

    /// Per vertex of the list the number of its mesh.
    pub fn meshes(&self) -> &[u32] {
        &self.model.mesh
    }

    /// The numbers of nodes, of meshes with faces, of primitives with faces, and of materials.
    pub fn counts(&self) -> [usize; 4] {
        let groups = &self.model.groups;
        let meshes = groups.chunk_by(|a, b| a.mesh == b.mesh).count();
        [self.nodes, meshes, groups.iter().map(|group| group.primitives.len()).sum(), self.materials]
    }

    /// Writes the file as .glb, atomically, with these coordinates, which are those of the corners of all faces of the list, v upwards.
    /// Vertices keep their numbers; those whose corners have several pairs are repeated behind all others, with all attributes and morph
    /// targets, bit for bit. All buffers become one, and pictures beside the file move into it.
    ///
    /// # Errors
    /// With the file untouched: [`Error::Size`] for another number of faces, [`Error::Argument`] for coordinates that are not finite and a
    /// set above 7, [`Error::Parse`] for a damaged attribute, [`Error::TooLarge`], [`Error::Io`].
    pub fn write(
        &self,
        path: &Path,
        corner_uv: &[[[f64; 2]; 3]],
        options: &SceneOptions,
    ) -> Result<SceneReport> {
        check_size("texture coordinates", corner_uv.len(), self.model.soup.faces.len())?;
        crate::mesh::io::soup::finite("texture coordinate", corner_uv.as_flattened())?;
        if let Some(set) = options.texcoord.filter(|set| *set > LARGEST_SET) {
            return Err(Error::argument("texcoord", set, "a set of texture coordinates from 0 to 7"));
        }
        with_file(&self.bytes, &self.name, self.folder.as_deref(), |file, budget| {
            let document = plain(file)?;
            let textures = textures(&document);
            let set = options.texcoord.unwrap_or_else(|| free_set(&document, &textures));
            let mut edit = SceneEdit {
                file,
                model: &self.model,
                corner_uv,
                set,
                tangents: options.tangents,
                textures: &textures,
                kept: KeptDocument::new(document),
                budget,
                report: self.report(set, &textures),
            };
            edit.edit()?;
            let SceneEdit { mut kept, mut report, .. } = edit;
            report.notes.extend(embed(&mut kept, self.folder.as_deref()));
            kept.chunks(file)?.write(path)?;
            Ok(report)
        })
    }

    /// The report before anything is written.
    fn report(&self, set: u32, textures: &[MaterialTextures]) -> SceneReport {
        let sets = || textures.iter().flat_map(|textures| &textures.sets);
        SceneReport {
            texcoord: set,
            n_kept_textures: sets().filter(|other| **other != set).count(),
            n_misplaced_textures: sets().filter(|other| **other == set).count(),
            n_shared_meshes: self.model.shared,
            ..SceneReport::default()
        }
    }
}

/// The document as plain JSON. Its entries that are edited are objects.
fn plain(file: &GltfFile<'_>) -> Result<Value> {
    let document: Value = match serde_json::from_slice(file.json) {
        Ok(document) => document,
        Err(error) => return file.whole().error(format!("the JSON of the file is damaged: {error}")),
    };
    match has_objects(&document) {
        true => Ok(document),
        false => {
            file.whole().error("the JSON of the file is not that of glTF: a list stands for an object".into())
        }
    }
}

/// True if the entries of the lists that are edited are objects.
fn has_objects(document: &Value) -> bool {
    let lists = ["accessors", "bufferViews", "images", "meshes"];
    let entries = lists.iter().filter_map(|list| document[list].as_array()).flatten();
    let primitives = document["meshes"].as_array().into_iter().flatten();
    let primitives = primitives.filter_map(|mesh| mesh["primitives"].as_array()).flatten();
    let attributes = primitives.clone().map(|primitive| &primitive["attributes"]);
    entries.chain(primitives).chain(attributes).chain([document]).all(Value::is_object)
}

/// The set that the atlas takes if none is asked for.
fn free_set(document: &Value, textures: &[MaterialTextures]) -> u32 {
    let is_used = |set: u32| textures.iter().any(|textures| textures.sets.contains(&set));
    if !is_used(0) {
        return 0;
    }
    let meshes = document["meshes"].as_array().into_iter().flatten();
    let primitives: Vec<&Value> = meshes.filter_map(|mesh| mesh["primitives"].as_array()).flatten().collect();
    let is_there = |set: u32| {
        let name = set_name(set);
        primitives.iter().any(|primitive| primitive["attributes"].get(&name).is_some())
    };
    // A document of finite length uses finitely many sets.
    (1..).find(|set| !is_used(*set) && !is_there(*set)).unwrap_or(LARGEST_SET)
}
