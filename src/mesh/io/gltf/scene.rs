//! The meshes of a scene, in space.

use super::super::budget::Budget;
use super::accessor::File;
use super::document::{Affine, Primitive, Shape};
use super::seams::first_alike;
use crate::error::{Error, Result};
use crate::mesh::Point;
use crate::mesh::io::soup::{Attributes, NO_NORMAL, NO_TEXCOORD, Soup, WHITE};
use crate::mesh::weld::place_key;

/// Modes of a primitive with faces.
const TRIANGLES: u32 = 4;
const STRIP: u32 = 5;
const FAN: u32 = 6;
/// Bytes of the budget that each primitive takes, an empty one too: nodes may show it often, and each time takes a while.
const PRIMITIVE: usize = 64;

/// All meshes below the roots of the scene: the default one, else the first, else every mesh where it stands.
pub(super) fn soup(file: &File<'_>, budget: Budget) -> Result<Soup> {
    let document = file.document;
    let mut out = Collected {
        file,
        budget,
        soup: Soup::default(),
        uv: Vec::new(),
        normals: Vec::new(),
        colors: Vec::new(),
        given: Vec::new(),
        first: Vec::new(),
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

/// What has been read so far; attributes are as long as the last primitive that has them made them.
struct Collected<'a> {
    file: &'a File<'a>,
    budget: Budget,
    soup: Soup,
    normals: Vec<Point>,
    colors: Vec<[f64; 4]>,
    uv: Vec<[[f64; 2]; 3]>,
    /// Per vertex of the file, the number that our writer gave it, or `NO_NUMBER`.
    given: Vec<u32>,
    /// Per vertex of the file, the first one that is the same.
    first: Vec<u32>,
}

/// Stands for the number of a vertex that another program wrote.
const NO_NUMBER: u32 = u32::MAX;

impl Collected<'_> {
    fn mesh(&mut self, index: u32, map: &Affine) -> Result<()> {
        let Some(mesh) = self.file.document.meshes.get(index as usize) else {
            return self.file.whole().error(format!("mesh {index} does not exist"));
        };
        for primitive in &mesh.primitives {
            self.budget.take(1, PRIMITIVE, "primitives", self.file.whole())?;
            self.primitive(primitive, map)?;
        }
        self.weld()
    }

    /// Vertices of the mesh that was read last are one where they are in one place, and have one number if they have any.
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
        let (file, place) = (self.file, self.file.whole());
        let named = &primitive.attributes;
        let Some(position) = named.position else { return Ok(()) };
        let positions = file.accessor(position, "POSITION", &[Shape::Vec3])?;
        let n = positions.count;
        let first = self.soup.positions.len();
        if first.checked_add(n).is_none_or(|end| end > u32::MAX as usize) {
            return Err(Error::TooLarge { what: "vertices", count: first.saturating_add(n) });
        }
        let budget = &mut self.budget;
        let mut positions: Vec<Point> = positions.numbers(0.0, "POSITION", budget, file)?;
        if *map != Affine::IDENTITY {
            positions.iter_mut().for_each(|p| *p = map.apply(*p));
        }
        let (turn, mirrors) = map.of_normals();
        let check = |what: &str, index: u32, count: usize| match count == n {
            true => Ok(()),
            false => file
                .place_of("accessors", index as usize)
                .error(format!("{what} has {count} elements, POSITION {n}")),
        };
        if let Some(index) = named.normal {
            let normals = file.accessor(index, "NORMAL", &[Shape::Vec3])?;
            check("NORMAL", index, normals.count)?;
            let mut normals: Vec<Point> = normals.numbers(0.0, "NORMAL", budget, file)?;
            if map.linear != Affine::IDENTITY.linear {
                normals.iter_mut().for_each(|x| *x = unit(turn.apply(*x)));
            }
            budget.take(first - self.normals.len(), size_of::<Point>(), "NORMAL", place)?;
            self.normals.resize(first, NO_NORMAL);
            self.normals.append(&mut normals);
        }
        if let Some(index) = named.color {
            let colors = file.accessor(index, "COLOR_0", &[Shape::Vec3, Shape::Vec4])?;
            check("COLOR_0", index, colors.count)?;
            budget.take(first - self.colors.len(), size_of::<[f64; 4]>(), "COLOR_0", place)?;
            self.colors.resize(first, WHITE);
            self.colors.append(&mut colors.numbers(1.0, "COLOR_0", budget, file)?);
        }
        let texcoords: Option<Vec<[f64; 2]>> = match named.texcoord {
            Some(index) => {
                let texcoords = file.accessor(index, "TEXCOORD_0", &[Shape::Vec2])?;
                check("TEXCOORD_0", index, texcoords.count)?;
                Some(texcoords.numbers(0.0, "TEXCOORD_0", budget, file)?)
            }
            None => None,
        };
        if let Some(index) = named.vertex {
            let numbers = file.accessor(index, "_RICCI_VERTEX", &[Shape::Vec2])?;
            check("_RICCI_VERTEX", index, numbers.count)?;
            let halves: Vec<[f64; 2]> = numbers.numbers(0.0, "_RICCI_VERTEX", budget, file)?;
            budget.take(first - self.given.len(), size_of::<u32>(), "_RICCI_VERTEX", place)?;
            self.given.resize(first, NO_NUMBER);
            self.given.extend(halves.into_iter().map(|[low, high]| low as u32 | (high as u32) << 16));
        }
        self.soup.positions.append(&mut positions);
        let mode = primitive.mode.unwrap_or(TRIANGLES);
        if !(TRIANGLES..=FAN).contains(&mode) {
            return Ok(());
        }
        let indices = match primitive.indices {
            Some(index) => file.accessor(index, "indices", &[Shape::Scalar])?.indices(n, budget, file)?,
            None => {
                budget.take(n, size_of::<u32>(), "indices", place)?;
                (0..n as u32).collect()
            }
        };
        let faces = if mode == TRIANGLES { indices.len() / 3 } else { indices.len().saturating_sub(2) };
        budget.take(faces, size_of::<[u32; 3]>(), "faces", place)?;
        if texcoords.is_some() {
            budget.take(faces, size_of::<[[f64; 2]; 3]>(), "faces", place)?;
        }
        if texcoords.is_some() {
            let before = self.soup.faces.len();
            budget.take(before - self.uv.len(), size_of::<[[f64; 2]; 3]>(), "TEXCOORD_0", place)?;
            self.uv.resize(before, [NO_TEXCOORD; 3]);
        }
        for f in 0..faces {
            let at = |k: usize| indices[k];
            let [a, b, c] = match mode {
                TRIANGLES => [at(3 * f), at(3 * f + 1), at(3 * f + 2)],
                STRIP if f % 2 == 0 => [at(f), at(f + 1), at(f + 2)],
                STRIP => [at(f + 1), at(f), at(f + 2)],
                _ => [at(0), at(f + 1), at(f + 2)],
            };
            // A repeated vertex stitches strips together.
            if mode == STRIP && (a == b || b == c || c == a) {
                continue;
            }
            let corners = if mirrors { [a, c, b] } else { [a, b, c] };
            self.soup.faces.push(corners.map(|v| first as u32 + v));
            if let Some(texcoords) = &texcoords {
                // v points down in glTF.
                self.uv.push(corners.map(|v| texcoords[v as usize]).map(|[s, t]| [s, 1.0 - t]));
            }
        }
        Ok(())
    }

    /// Attributes that some primitives lack are filled up, and vertices renumbered.
    fn finish(mut self) -> Result<Soup> {
        let Collected { mut soup, mut normals, mut colors, mut uv, mut first, .. } = self;
        let (whole, n) = (self.file.whole(), soup.positions.len());
        let budget = &mut self.budget;
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
        // From here on a vertex that is the first of its kind has its final number in `first`, and the others that of theirs.
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
        soup.attributes =
            Attributes { normals: some(normals), corner_normals, colors: some(colors), uv: some(uv) };
        Ok(soup)
    }
}

/// A vector of length 1 in the same direction; one without a direction stays as it is.
fn unit(x: Point) -> Point {
    let length = x[0].hypot(x[1]).hypot(x[2]);
    if length > 0.0 && length.is_finite() { x.map(|x| x / length) } else { x }
}
