//! Assembly of the meshes of a glTF scene in space.

use super::super::budget::Budget;
use super::super::scan::Location;
use super::accessor::GltfFile;
use super::document::{Affine, AttributeAccessors, ElementShape, Primitive};
use super::materials::labels_of;
use super::seams::first_alike;
use crate::error::{Error, Result};
use crate::mesh::Point;
use crate::mesh::incidence::distinct;
use crate::mesh::io::soup::{Attributes, NO_NORMAL, NO_TEXCOORD, Soup, WHITE};
use crate::mesh::weld::place_key;

/// Modes of a primitive with faces.
pub(super) const TRIANGLES: u32 = 4;
const STRIP: u32 = 5;
pub(super) const FAN: u32 = 6;
/// Bytes that each primitive takes off the budget, even an empty one: nodes may use one mesh often, and each use takes time.
const PRIMITIVE: usize = 64;

/// All meshes below the roots of the scene: the default one, else the first, else every mesh where it is.
pub(super) fn soup(file: &GltfFile<'_>, budget: Budget) -> Result<Soup> {
    let document = file.document;
    let mut out = CollectedMeshes {
        file,
        budget,
        soup: Soup::default(),
        uv: Vec::new(),
        normals: Vec::new(),
        colors: Vec::new(),
        given: Vec::new(),
        first: Vec::new(),
        materials: Vec::new(),
        last: None,
    };
    let scene = match document.scene {
        Some(i) if i >= document.scenes.len() => {
            return file.whole().error(format!("scene {i} does not exist"));
        }
        Some(i) => Some(&document.scenes[i]),
        None => document.scenes.first(),
    };
    let Some(scene) = scene else {
        for mesh in 0..document.meshes.len() {
            out.mesh(mesh as u32, &Affine::IDENTITY)?;
        }
        return out.finish();
    };
    // Nodes are a forest: one that is met twice would be its own ancestor, or count its meshes twice.
    let mut met = vec![false; document.nodes.len()];
    let mut open: Vec<(u32, Affine)> =
        scene.nodes.iter().rev().map(|&node| (node, Affine::IDENTITY)).collect();
    while let Some((index, above)) = open.pop() {
        let (Some(node), Some(met)) = (document.nodes.get(index as usize), met.get_mut(index as usize))
        else {
            return file.whole().error(format!("node {index} does not exist"));
        };
        if std::mem::replace(met, true) {
            return file
                .place_of("nodes", index as usize)
                .error(format!("node {index} has two parents, or is below itself"));
        }
        let here = node.transform.as_ref().map_or(above, |local| above.after(local));
        if let Some(mesh) = node.mesh {
            out.mesh(mesh, if node.skinned { &Affine::IDENTITY } else { &here })?;
        }
        open.extend(node.children.iter().rev().map(|&child| (child, here)));
    }
    out.finish()
}

/// The primitives that have been read. The list of an attribute ends with the last primitive that has it.
struct CollectedMeshes<'a> {
    file: &'a GltfFile<'a>,
    budget: Budget,
    soup: Soup,
    normals: Vec<Point>,
    colors: Vec<[f64; 4]>,
    uv: Vec<[[f64; 2]; 3]>,
    /// For each vertex of the file the number that this library's writer gave it, or `NO_NUMBER`.
    given: Vec<u32>,
    /// For each vertex of the file the first vertex of its mesh that is the same vertex of the surface.
    first: Vec<u32>,
    /// For each face the number of its material and 1, or 0.
    materials: Vec<u32>,
    /// The vertices of the last primitive of the same mesh.
    last: Option<PrimitiveVertices>,
}

/// The vertices of a primitive, which the next one may share.
struct PrimitiveVertices {
    accessors: [Option<u32>; 5],
    first: usize,
    n: usize,
    texcoords: Vec<[f64; 2]>,
}

/// The number of a vertex that another program wrote.
const NO_NUMBER: u32 = u32::MAX;

/// The name of an attribute, the shapes that it may have, and the value with which components are filled up.
struct AttributeReader<'a> {
    what: &'static str,
    shapes: &'a [ElementShape],
    fill: f64,
}

/// Appends the elements of a primitive to a list, after `first` elements of earlier primitives. If these lack the attribute, the list is
/// filled up with defaults.
struct ListAppender<'a> {
    budget: &'a mut Budget,
    place: Location<'a>,
    first: usize,
}

impl ListAppender<'_> {
    fn to<T: Copy>(&mut self, list: &mut Vec<T>, mut elements: Vec<T>, default: T) -> Result<()> {
        if !elements.is_empty() {
            self.budget.take(self.first - list.len(), size_of::<T>(), "attributes", self.place)?;
            list.resize(self.first, default);
            list.append(&mut elements);
        }
        Ok(())
    }
}

impl CollectedMeshes<'_> {
    fn mesh(&mut self, index: u32, map: &Affine) -> Result<()> {
        let Some(mesh) = self.file.document.meshes.get(index as usize) else {
            return self.file.whole().error(format!("mesh {index} does not exist"));
        };
        self.last = None;
        for primitive in &mesh.primitives {
            self.budget.take(1, PRIMITIVE, "primitives", self.file.whole())?;
            self.primitive(primitive, map)?;
        }
        self.weld()
    }

    /// Joins vertices of the last mesh with the same position, unless this library's writer gave them different numbers.
    fn weld(&mut self) -> Result<()> {
        let (start, end) = (self.first.len() as u32, self.soup.positions.len() as u32);
        self.budget.take((end - start) as usize, 2 * size_of::<u32>(), "vertices", self.file.whole())?;
        let place = |v: u32| place_key(self.soup.positions[v as usize]);
        let number = |v: u32| self.given.get(v as usize).copied().unwrap_or(NO_NUMBER);
        let first = first_alike(start..end, |v| (place(v), number(v)));
        self.first.extend(first);
        Ok(())
    }

    fn primitive(&mut self, primitive: &Primitive, map: &Affine) -> Result<()> {
        let named = &primitive.attributes;
        let accessors = [named.position, named.normal, named.color, named.texcoord, named.vertex];
        let PrimitiveVertices { first, n, texcoords, .. } = match self.last.take() {
            Some(last) if last.accessors == accessors => last,
            _ => {
                let Some(new) = self.vertices(named, accessors, map)? else { return Ok(()) };
                new
            }
        };
        let file = self.file;
        let mut faces = faces(primitive, n, &mut self.budget, file)?;
        if map.of_normals().1 {
            faces.iter_mut().for_each(|face| face.swap(1, 2));
        }
        if !texcoords.is_empty() {
            self.budget.take(faces.len(), size_of::<[[f64; 2]; 3]>(), "faces", file.whole())?;
            // v points down in glTF.
            let at = |v: u32| [texcoords[v as usize][0], 1.0 - texcoords[v as usize][1]];
            let uv = faces.iter().map(|face| face.map(at)).collect();
            let first = self.soup.faces.len();
            let mut append = ListAppender { budget: &mut self.budget, place: file.whole(), first };
            append.to(&mut self.uv, uv, [NO_TEXCOORD; 3])?;
        }
        self.soup.faces.extend(faces.into_iter().map(|face| face.map(|v| first as u32 + v)));
        self.material(primitive.material)?;
        self.last = Some(PrimitiveVertices { accessors, first, n, texcoords });
        Ok(())
    }

    /// Gives the faces that were added last their material.
    fn material(&mut self, material: Option<u32>) -> Result<()> {
        let file = self.file;
        if material.is_some_and(|k| k as usize >= file.document.materials.len()) {
            return file.whole().error(format!("material {} does not exist", material.unwrap_or_default()));
        }
        let wanted = self.soup.faces.len();
        self.budget.take(wanted - self.materials.len(), size_of::<u32>(), "materials", file.whole())?;
        self.materials.resize(wanted, material.map_or(0, |k| k + 1));
        Ok(())
    }

    /// Adds the vertices of a primitive with these attributes; none without positions.
    fn vertices(
        &mut self,
        named: &AttributeAccessors,
        accessors: [Option<u32>; 5],
        map: &Affine,
    ) -> Result<Option<PrimitiveVertices>> {
        let file = self.file;
        let Some(position) = named.position else { return Ok(None) };
        let n = file.accessor(position, "POSITION", &[ElementShape::Vec3])?.count;
        let first = self.soup.positions.len();
        if first.checked_add(n).is_none_or(|end| end > u32::MAX as usize) {
            return Err(Error::TooLarge { what: "vertices", count: first.saturating_add(n) });
        }
        let three = |what| AttributeReader { what, shapes: &[ElementShape::Vec3], fill: 0.0 };
        let mut positions: Vec<Point> = self.attribute(named.position, n, three("POSITION"))?;
        if *map != Affine::IDENTITY {
            positions.iter_mut().for_each(|p| *p = map.apply(*p));
        }
        let (turn, _) = map.of_normals();
        let mut normals: Vec<Point> = self.attribute(named.normal, n, three("NORMAL"))?;
        if map.linear != Affine::IDENTITY.linear {
            normals.iter_mut().for_each(|x| *x = unit(turn.apply(*x)));
        }
        let either = &[ElementShape::Vec3, ElementShape::Vec4];
        let colors =
            self.attribute(named.color, n, AttributeReader { what: "COLOR_0", shapes: either, fill: 1.0 })?;
        let pair = |what| AttributeReader { what, shapes: &[ElementShape::Vec2], fill: 0.0 };
        let texcoords: Vec<[f64; 2]> = self.attribute(named.texcoord, n, pair("TEXCOORD_0"))?;
        let halves: Vec<[f64; 2]> = self.attribute(named.vertex, n, pair("_RICCI_VERTEX"))?;
        let numbers = halves.into_iter().map(|[low, high]| low as u32 | (high as u32) << 16).collect();
        let mut append = ListAppender { budget: &mut self.budget, place: file.whole(), first };
        append.to(&mut self.normals, normals, NO_NORMAL)?;
        append.to(&mut self.colors, colors, WHITE)?;
        append.to(&mut self.given, numbers, NO_NUMBER)?;
        self.soup.positions.append(&mut positions);
        Ok(Some(PrimitiveVertices { accessors, first, n, texcoords }))
    }

    /// The elements of an attribute, one for each of the `n` vertices of a primitive; none if it does not have the attribute.
    fn attribute<const N: usize>(
        &mut self,
        index: Option<u32>,
        n: usize,
        read: AttributeReader<'_>,
    ) -> Result<Vec<[f64; N]>> {
        let Some(index) = index else { return Ok(Vec::new()) };
        let accessor = self.file.accessor(index, read.what, read.shapes)?;
        if accessor.count != n {
            let message = format!("{} has {} elements, POSITION {n}", read.what, accessor.count);
            return accessor.place(self.file).error(message);
        }
        accessor.numbers(read.fill, &mut self.budget, self.file)
    }

    /// Fills up attributes that some primitives lack, and renumbers vertices.
    fn finish(self) -> Result<Soup> {
        let CollectedMeshes {
            file,
            mut budget,
            mut soup,
            mut normals,
            mut colors,
            mut uv,
            mut first,
            materials,
            ..
        } = self;
        let (whole, n) = (file.whole(), soup.positions.len());
        let mut fill = |have: usize, wanted: usize, size: usize| match have {
            0 => Ok(()),
            have => budget.take(wanted - have, size, "attributes", whole),
        };
        fill(normals.len(), n, size_of::<Point>())?;
        fill(colors.len(), n, size_of::<[f64; 4]>())?;
        fill(uv.len(), soup.faces.len(), size_of::<[[f64; 2]; 3]>())?;
        normals.resize(if normals.is_empty() { 0 } else { n }, NO_NORMAL);
        colors.resize(if colors.is_empty() { 0 } else { n }, WHITE);
        uv.resize(if uv.is_empty() { 0 } else { soup.faces.len() }, [NO_TEXCOORD; 3]);
        let mut corner_normals = None;
        if (0..normals.len()).any(|v| normals[v] != normals[first[v] as usize]) {
            budget.take(soup.faces.len(), size_of::<[Point; 3]>(), "normals", whole)?;
            corner_normals = Some(soup.faces.iter().map(|f| f.map(|v| normals[v as usize])).collect());
            normals.clear();
        }
        // `first` becomes the final number of each vertex: for a first vertex, the number of first vertices before it.
        let mut kept = 0;
        for v in 0..n {
            if first[v] as usize == v {
                first[v] = kept as u32;
                soup.positions[kept] = soup.positions[v];
                normals.get(v).copied().into_iter().for_each(|x| normals[kept] = x);
                colors.get(v).copied().into_iter().for_each(|x| colors[kept] = x);
                kept += 1;
            } else {
                first[v] = first[first[v] as usize];
            }
        }
        soup.positions.truncate(kept);
        normals.truncate(kept);
        colors.truncate(kept);
        soup.faces.as_flattened_mut().iter_mut().for_each(|v| *v = first[*v as usize]);
        fn some<T>(list: Vec<T>) -> Option<Vec<T>> {
            Some(list).filter(|list| !list.is_empty())
        }
        let (normals, colors, uv) = (some(normals), some(colors), some(uv));
        let unread = file.document.unread();
        let labels = labels_of(file.document, materials);
        let attributes =
            Attributes { normals, corner_normals, colors, uv, labels, unread, ..Attributes::default() };
        soup.attributes = attributes.finite_only();
        Ok(soup)
    }
}

/// The faces of a primitive with `n` vertices, numbered from 0; none of points and lines.
pub(super) fn faces(
    primitive: &Primitive,
    n: usize,
    budget: &mut Budget,
    file: &GltfFile<'_>,
) -> Result<Vec<[u32; 3]>> {
    let place = file.whole();
    let mode = primitive.mode.unwrap_or(TRIANGLES);
    if !(TRIANGLES..=FAN).contains(&mode) {
        return Ok(Vec::new());
    }
    let at = match primitive.indices {
        Some(index) => file.accessor(index, "indices", &[ElementShape::Scalar])?.indices(n, budget, file)?,
        None => {
            budget.take(n, size_of::<u32>(), "indices", place)?;
            (0..n as u32).collect()
        }
    };
    let count = if mode == TRIANGLES { at.len() / 3 } else { at.len().saturating_sub(2) };
    budget.take(count, 2 * size_of::<[u32; 3]>(), "faces", place)?;
    let face = |f: usize| match mode {
        TRIANGLES => [at[3 * f], at[3 * f + 1], at[3 * f + 2]],
        STRIP if f.is_multiple_of(2) => [at[f], at[f + 1], at[f + 2]],
        STRIP => [at[f + 1], at[f], at[f + 2]],
        _ => [at[0], at[f + 1], at[f + 2]],
    };
    // A repeated vertex joins strips together.
    Ok((0..count).map(face).filter(|face| mode != STRIP || distinct(face)).collect())
}

/// The vector of length 1 in the same direction; a vector of length 0, or one that is not finite, is returned unchanged.
pub(super) fn unit(x: Point) -> Point {
    let length = x[0].hypot(x[1]).hypot(x[2]);
    if length > 0.0 && length.is_finite() { x.map(|x| x / length) } else { x }
}
