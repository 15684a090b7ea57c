//! The meshes of a glTF file as one triangle list that leads back to them: each mesh once, however many nodes show it.

use super::super::budget::Budget;
use super::accessor::GltfFile;
use super::document::{Affine, ElementShape, Primitive};
use super::scene::{FAN, TRIANGLES, faces};
use crate::error::{Error, Result};
use crate::mesh::Point;
use crate::mesh::io::Soup;
use serde_json::Value;
use std::ops::Range;

/// The triangles of all meshes of a document.
#[derive(Default)]
pub(super) struct SceneModel {
    /// The positions as the node shows them that enlarges the mesh most, so that lengths are those of the scene. Faces run as the file
    /// says, also where that node mirrors.
    pub soup: Soup,
    /// Per vertex its mesh.
    pub mesh: Vec<u32>,
    pub groups: Vec<VertexGroup>,
    /// The number of meshes that several nodes show.
    pub shared: usize,
}

/// The primitives of a mesh that have the same attributes, and so the same vertices.
pub(super) struct VertexGroup {
    pub mesh: usize,
    /// The first vertex in the list, and their number.
    pub first: usize,
    pub n: usize,
    /// The accessor of the positions.
    pub position: u32,
    pub primitives: Vec<GroupPrimitive>,
    /// The attributes as text.
    key: String,
}

/// A primitive with faces.
pub(super) struct GroupPrimitive {
    /// Its number in its mesh.
    pub index: usize,
    /// Its faces in the list.
    pub faces: Range<usize>,
    /// True for a plain list of triangles, false for strips and fans.
    pub is_list: bool,
    pub material: Option<usize>,
}

/// The place of a mesh in the scene.
#[derive(Clone, Copy)]
struct MeshPlace {
    map: Affine,
    /// The root of the sum of the squares of the map's linear part.
    size: f64,
    nodes: usize,
}

/// The model of a file; `document` is the same document as plain JSON.
pub(super) fn model(file: &GltfFile<'_>, document: &Value, budget: Budget) -> Result<SceneModel> {
    let places = places(file)?;
    let shared = places.iter().filter(|place| place.nodes > 1).count();
    let mut reader = SceneReader { file, budget, model: SceneModel { shared, ..SceneModel::default() } };
    for (number, (mesh, place)) in file.document.meshes.iter().zip(&places).enumerate() {
        for (index, primitive) in mesh.primitives.iter().enumerate() {
            let text = &document["meshes"][number]["primitives"][index];
            let key = format!("{} {}", text["attributes"], text["targets"]);
            if let Some(group) = reader.group(number, &key, primitive, &place.map)? {
                reader.faces(group, index, primitive)?;
            }
        }
    }
    Ok(reader.model)
}

/// A model while it is read.
struct SceneReader<'a> {
    file: &'a GltfFile<'a>,
    budget: Budget,
    model: SceneModel,
}

impl SceneReader<'_> {
    /// The group of the vertices of a primitive of a mesh, whose positions are added if they are new; none for one without faces.
    fn group(
        &mut self,
        mesh: usize,
        key: &str,
        primitive: &Primitive,
        map: &Affine,
    ) -> Result<Option<usize>> {
        let has_faces = (TRIANGLES..=FAN).contains(&primitive.mode.unwrap_or(TRIANGLES));
        let Some(position) = primitive.attributes.position.filter(|_| has_faces) else { return Ok(None) };
        let model = &mut self.model;
        let known = model.groups.iter().rposition(|group| group.mesh == mesh && group.key == key);
        if known.is_some() {
            return Ok(known);
        }
        let accessor = self.file.accessor(position, "POSITION", &[ElementShape::Vec3])?;
        let (first, n) = (model.soup.positions.len(), accessor.count);
        let end = first.saturating_add(n);
        if end > u32::MAX as usize {
            return Err(Error::TooLarge { what: "vertices", count: end });
        }
        let positions: Vec<Point> = accessor.numbers(0.0, &mut self.budget, self.file)?;
        model.soup.positions.extend(positions.into_iter().map(|p| map.apply(p)));
        model.mesh.resize(end, mesh as u32);
        model.groups.push(VertexGroup { mesh, first, n, position, primitives: Vec::new(), key: key.into() });
        Ok(Some(model.groups.len() - 1))
    }

    /// Adds the faces of a primitive to its group.
    fn faces(&mut self, group: usize, index: usize, primitive: &Primitive) -> Result<()> {
        let SceneModel { soup, groups, .. } = &mut self.model;
        let VertexGroup { first, n, primitives, .. } = &mut groups[group];
        let start = soup.faces.len();
        let own = faces(primitive, *n, &mut self.budget, self.file)?;
        soup.faces.extend(own.into_iter().map(|face| face.map(|v| *first as u32 + v)));
        primitives.push(GroupPrimitive {
            index,
            faces: start..soup.faces.len(),
            is_list: primitive.mode.unwrap_or(TRIANGLES) == TRIANGLES,
            material: primitive.material.map(|k| k as usize),
        });
        Ok(())
    }
}

/// For each mesh the map of the node that enlarges it most; the identity for one that no node shows, or that follows a skin.
fn places(file: &GltfFile<'_>) -> Result<Vec<MeshPlace>> {
    let document = file.document;
    let unseen = MeshPlace { map: Affine::IDENTITY, size: 0.0, nodes: 0 };
    let mut places = vec![unseen; document.meshes.len()];
    let mut is_child = vec![false; document.nodes.len()];
    for child in document.nodes.iter().flat_map(|node| &node.children) {
        match is_child.get_mut(*child as usize) {
            Some(known) if !*known => *known = true,
            Some(_) => {
                let place = file.place_of("nodes", *child as usize);
                return place.error(format!("node {child} has two parents"));
            }
            None => return file.whole().error(format!("node {child} does not exist")),
        }
    }
    let mut open: Vec<(usize, Affine)> = Vec::new();
    open.extend((0..is_child.len()).rev().filter(|k| !is_child[*k]).map(|k| (k, Affine::IDENTITY)));
    let mut met = 0;
    while let Some((index, above)) = open.pop() {
        met += 1;
        let node = &document.nodes[index];
        let here = node.transform.as_ref().map_or(above, |local| above.after(local));
        open.extend(node.children.iter().rev().map(|&child| (child as usize, here)));
        let Some(mesh) = node.mesh else { continue };
        let Some(place) = places.get_mut(mesh as usize) else {
            return file.whole().error(format!("mesh {mesh} does not exist"));
        };
        let map = if node.skinned { Affine::IDENTITY } else { here };
        let size = map.linear.as_flattened().iter().map(|x| x * x).sum::<f64>().sqrt();
        place.nodes += 1;
        if size > place.size {
            (place.map, place.size) = (map, size);
        }
    }
    match met == document.nodes.len() {
        true => Ok(places),
        // Each node has at most one parent, so that those that no root leads to are in a circle.
        false => file.whole().error("nodes are below themselves".into()),
    }
}
