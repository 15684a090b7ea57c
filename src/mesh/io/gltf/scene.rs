//! The meshes of a scene, in space.

use super::super::budget::Budget;
use super::super::{Attributes, Point, Soup};
use super::accessor::File;
use super::document::{Affine, Primitive, Shape};
use crate::error::{Error, Result};

/// Modes of a primitive with faces.
const TRIANGLES: u32 = 4;
const STRIP: u32 = 5;
const FAN: u32 = 6;
/// Bytes that reading a primitive costs at least: an empty one that is shown often takes its time too.
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
        return Ok(out.finish());
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
    Ok(out.finish())
}

/// What has been read so far; attributes that some primitive lacks stay short.
struct Collected<'a> {
    file: &'a File<'a>,
    budget: Budget,
    soup: Soup,
    normals: Vec<Point>,
    colors: Vec<[f64; 4]>,
    uv: Vec<[[f64; 2]; 3]>,
}

impl Collected<'_> {
    fn mesh(&mut self, index: u32, map: &Affine) -> Result<()> {
        let Some(mesh) = self.file.document.meshes.get(index as usize) else {
            return self.file.whole().error(format!("mesh {index} does not exist"));
        };
        for primitive in &mesh.primitives {
            self.budget.take(1, PRIMITIVE, "primitives", self.file.whole())?;
            self.primitive(primitive, map)?;
        }
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
            self.normals.append(&mut normals);
        }
        if let Some(index) = named.color {
            let colors = file.accessor(index, "COLOR_0", &[Shape::Vec3, Shape::Vec4])?;
            check("COLOR_0", index, colors.count)?;
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

    fn finish(self) -> Soup {
        let Collected { mut soup, normals, colors, uv, .. } = self;
        let n = soup.positions.len();
        let whole = |len: usize, needed: usize| needed > 0 && len == needed;
        soup.attributes = Attributes {
            normals: whole(normals.len(), n).then_some(normals),
            colors: whole(colors.len(), n).then_some(colors),
            uv: whole(uv.len(), soup.faces.len()).then_some(uv),
        };
        soup
    }
}

/// A vector of length 1 in the same direction; one without a direction stays as it is.
fn unit(x: Point) -> Point {
    let length = x[0].hypot(x[1]).hypot(x[2]);
    if length > 0.0 && length.is_finite() { x.map(|x| x / length) } else { x }
}
