//! What a view shows of a surface: the surface itself and, beside it, its texture coordinates or another surface with the same vertices.

use ricci::mesh::Point;
use ricci::mesh::io::Soup;
use std::collections::HashMap;
use std::hash::Hash;

/// The vertices of a view and its faces. A vertex on a seam of texture coordinates is there once for each of their values; vertices without
/// a face are left out.
pub struct ViewSides {
    pub places: Vec<Point>,
    pub corners: Vec<[u32; 3]>,
    /// The image of each vertex; its third coordinate is 0 in the plane.
    pub image: Option<Vec<Point>>,
    /// Whether the image lies in the plane.
    pub flat: bool,
    /// The vertex of the file of each vertex.
    pub origins: Vec<u32>,
    /// The number of the file's faces that are not shown: one of their vertices is not there, or one of their numbers not finite.
    pub left_out: usize,
}

impl ViewSides {
    /// A surface without an image.
    pub fn alone(soup: &Soup) -> ViewSides {
        ViewSides::of(soup, false, |v, _| v, |_, _| None)
    }

    /// A surface beside its texture coordinates; alone where it has none.
    pub fn textured(soup: &Soup) -> ViewSides {
        let Some(uv) = &soup.attributes.uv else { return ViewSides::alone(soup) };
        let key = |v, [f, k]: [usize; 2]| (v, uv[f][k].map(f64::to_bits));
        ViewSides::of(soup, true, key, |_, [f, k]| Some([uv[f][k][0], uv[f][k][1], 0.0]))
    }

    /// A surface beside an image of each of its vertices in space.
    pub fn imaged(soup: &Soup, image: &[Point]) -> ViewSides {
        ViewSides::of(soup, false, |v, _| v, |v, _| Some(image[v as usize]))
    }

    /// The view whose vertices are the different keys of corners, in the order in which faces name them; a corner is a face and a number
    /// from 0 to 2.
    fn of<K: Hash + Eq>(
        soup: &Soup,
        flat: bool,
        key: impl Fn(u32, [usize; 2]) -> K,
        image: impl Fn(u32, [usize; 2]) -> Option<Point>,
    ) -> ViewSides {
        let finite = |p: &Point| p.iter().all(|x| x.is_finite());
        let is_shown = |f: usize, corners: &[u32; 3]| {
            (0..3).all(|k| {
                let v = corners[k];
                soup.positions.get(v as usize).is_some_and(finite)
                    && image(v, [f, k]).as_ref().is_none_or(finite)
            })
        };
        let (mut places, mut images, mut origins, mut number) =
            (Vec::new(), Vec::new(), Vec::new(), HashMap::new());
        let mut corner = |v: u32, at: [usize; 2]| {
            *number.entry(key(v, at)).or_insert_with(|| {
                places.push(soup.positions[v as usize]);
                images.extend(image(v, at));
                origins.push(v);
                places.len() as u32 - 1
            })
        };
        let shown = soup.faces.iter().enumerate().filter(|(f, corners)| is_shown(*f, corners));
        let corners: Vec<[u32; 3]> =
            shown.map(|(f, corners)| [0, 1, 2].map(|k| corner(corners[k], [f, k]))).collect();
        let (left_out, is_beside) = (soup.faces.len() - corners.len(), images.len() == places.len());
        let image = is_beside.then_some(images).filter(|images| !images.is_empty());
        ViewSides { places, corners, flat: flat && image.is_some(), image, origins, left_out }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_without_a_face_and_faces_that_are_not_finite_are_left_out() {
        let soup = Soup {
            positions: vec![[9.0; 3], [0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [f64::NAN; 3]],
            faces: vec![[2, 3, 4], [3, 1, 2], [1, 2, 7]],
            ..Soup::default()
        };
        let sides = ViewSides::textured(&soup);
        assert_eq!(
            (sides.left_out, &sides.corners[..], &sides.origins[..]),
            (2, &[[0, 1, 2]][..], &[3, 1, 2][..])
        );
        assert!(sides.image.is_none() && !sides.flat);
    }
}
