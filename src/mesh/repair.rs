//! Repair of triangle lists, as far as it needs no guess.
//!
//! ```
//! use ricci::mesh::io::Soup;
//! use ricci::mesh::repair::{Repair, repair};
//! let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
//! let soup = Soup::new(positions, vec![[0, 1, 2], [1, 2, 3]]); // the second face looks the other way
//! let repaired = repair(&soup, &Repair::default())?;
//! assert_eq!((repaired.steps.turned_faces, repaired.diagnosis.defects.len()), (1, 0));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::check::{Defect, Diagnosis, Orientation, Piece, diagnose};
use super::incidence::{Incidence, NONE, components, connected, distinct, drop_unused};
use super::io::{Attributes, Soup};
pub use super::join::RefusedWeld;
use super::join::{join, repeats};
use super::weld::{check_tolerance, coincident};
use crate::error::{Error, Result};
use std::collections::HashSet;

/// Options of [`repair()`]. Every repair drops faces that use a vertex twice or repeat another face, gives each fan of faces a vertex of
/// its own, turns faces until neighbours agree, and drops isolated vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Repair {
    /// Vertices within this distance become one (transitively; the first one's position stays); 0: those in exactly the same
    /// place, where their faces are then connected through edges; in edges in which more than two faces would meet it is refused
    /// ([`Repaired::weld_refused`]); `None`: no welding. Default 0.
    pub weld: Option<f64>,
    /// Cut the surface open along edges in which more than two faces meet. Default no: which faces belong together would be a
    /// guess.
    pub cut_non_manifold_edges: bool,
    /// Keep one connected piece only: 0 is that with the most faces, and so on. Default all.
    pub component: Option<usize>,
}

impl Default for Repair {
    fn default() -> Self {
        Repair { weld: Some(0.0), cut_non_manifold_edges: false, component: None }
    }
}

/// How often each repair was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Steps {
    /// Vertices that became one with an earlier vertex.
    pub welded_vertices: usize,
    /// Faces dropped because they used a vertex twice (after welding).
    pub degenerate_faces: usize,
    /// Faces dropped because an earlier face had their vertices.
    pub duplicate_faces: usize,
    /// Edges along which the surface was cut open.
    pub cut_edges: usize,
    /// Vertices made for further fans of faces.
    pub split_vertices: usize,
    /// Faces turned around.
    pub turned_faces: usize,
    /// Faces of other components than the one that was asked for.
    pub faces_of_other_components: usize,
    /// Vertices dropped because no face uses them.
    pub isolated_vertices: usize,
}

/// A repaired triangle list, with the way back.
#[derive(Debug, Clone, PartialEq)]
pub struct Repaired {
    /// The result; its elements keep the order of the input's.
    pub soup: Soup,
    /// For each vertex of the result, the input's vertex that it was.
    pub vertex_origin: Vec<u32>,
    /// For each face of the result, the input's face that it was.
    pub face_origin: Vec<u32>,
    /// What was done.
    pub steps: Steps,
    /// The edges that kept vertices in exactly the same place from being welded throughout.
    pub weld_refused: Vec<RefusedWeld>,
    /// What is left: defects that cannot be mended without a guess.
    pub diagnosis: Diagnosis,
}

/// Repair a triangle list. Attributes stay with their elements.
///
/// # Errors
///
/// [`Error::Defects`] for faces that name missing vertices and used vertices without finite coordinates, which nothing
/// can mend; [`Error::Argument`] for a tolerance that is negative or not finite and a component that does not exist.
pub fn repair(soup: &Soup, options: &Repair) -> Result<Repaired> {
    refuse_garbage(soup)?;
    let mut work = Work {
        faces: soup.faces.clone(),
        origin: (0..soup.faces.len() as u32).collect(),
        turned: vec![false; soup.faces.len()],
        vertex_origin: (0..soup.positions.len() as u32).collect(),
        steps: Steps::default(),
        weld_refused: Vec::new(),
    };
    work.drop_bad_faces();
    work.weld(soup, options.weld)?;
    work.drop_bad_faces();
    work.separate(options.cut_non_manifold_edges);
    work.orient();
    work.take(options.component)?;
    Ok(work.finish(soup))
}

fn refuse_garbage(soup: &Soup) -> Result<()> {
    let n = soup.positions.len();
    let bad = |&v: &u32| soup.positions.get(v as usize).is_none_or(|p| !p.iter().all(|x| x.is_finite()));
    if !soup.faces.as_flattened().iter().any(bad) {
        return Ok(());
    }
    let mut diagnosis = diagnose(&soup.positions, &soup.faces);
    let used: HashSet<u32> =
        soup.faces.as_flattened().iter().copied().filter(|&v| (v as usize) < n).collect();
    diagnosis.defects.retain(|defect| match defect.code() {
        "index_out_of_range" => true,
        "non_finite_coordinate" => defect.vertices().iter().all(|v| used.contains(v)),
        _ => false,
    });
    Err(Error::Defects(Box::new(diagnosis)))
}

/// The list under repair.
struct Work {
    faces: Vec<[u32; 3]>,
    /// Per face: the input's face, and whether it was turned.
    origin: Vec<u32>,
    turned: Vec<bool>,
    /// Per vertex: the input's vertex.
    vertex_origin: Vec<u32>,
    steps: Steps,
    weld_refused: Vec<RefusedWeld>,
}

impl Work {
    fn incidence(&self) -> Incidence {
        Incidence::new(self.vertex_origin.len(), &self.faces)
    }

    fn weld(&mut self, soup: &Soup, tolerance: Option<f64>) -> Result<()> {
        let Some(tolerance) = tolerance else { return Ok(()) };
        check_tolerance(tolerance)?;
        let first = coincident(&soup.positions, tolerance);
        if tolerance == 0.0 {
            (self.faces, self.weld_refused) = join(&self.faces, &first);
            for face in self.weld_refused.iter_mut().flat_map(|refused| &mut refused.faces) {
                *face = self.origin[*face as usize];
            }
        } else {
            self.faces.as_flattened_mut().iter_mut().for_each(|v| *v = first[*v as usize]);
        }
        let mut used = vec![false; first.len()];
        self.faces.as_flattened().iter().for_each(|&v| used[v as usize] = true);
        let gone = |&(v, &to): &(usize, &u32)| v as u32 != to && !used[v];
        self.steps.welded_vertices = first.iter().enumerate().filter(gone).count();
        Ok(())
    }

    /// Drop the faces for which `keep` is false; returns their number.
    fn retain(&mut self, keep: &[bool]) -> usize {
        let before = self.faces.len();
        fn chosen<T: Copy>(list: &mut Vec<T>, keep: &[bool]) {
            let mut flags = keep.iter();
            list.retain(|_| flags.next().copied().unwrap_or(false));
        }
        chosen(&mut self.faces, keep);
        chosen(&mut self.origin, keep);
        chosen(&mut self.turned, keep);
        before - self.faces.len()
    }

    fn drop_bad_faces(&mut self) {
        let proper: Vec<bool> = self.faces.iter().map(distinct).collect();
        self.steps.degenerate_faces += self.retain(&proper);
        let first: Vec<bool> = repeats(&self.faces).into_iter().map(|again| !again).collect();
        self.steps.duplicate_faces += self.retain(&first);
    }

    /// A vertex of its own for every fan of faces. With `cut`, edges with more than two faces hold no fan together.
    fn separate(&mut self, cut: bool) {
        let incidence = self.incidence();
        if cut {
            self.steps.cut_edges = incidence.edges().filter(|sides| sides.len() > 2).count();
        }
        let mut corners = incidence.fans(&self.faces, if cut { 2 } else { usize::MAX });
        // The fan of the lowest corner keeps the vertex.
        let mut taken = vec![false; self.vertex_origin.len()];
        let mut vertex_of_fan = vec![NONE; 3 * self.faces.len()];
        for corner in 0..3 * self.faces.len() {
            let v = self.faces[corner / 3][corner % 3];
            let fan = corners.root(corner as u32) as usize;
            if vertex_of_fan[fan] == NONE {
                vertex_of_fan[fan] = v;
                if std::mem::replace(&mut taken[v as usize], true) {
                    vertex_of_fan[fan] = self.vertex_origin.len() as u32;
                    self.vertex_origin.push(self.vertex_origin[v as usize]);
                    self.steps.split_vertices += 1;
                }
            }
            self.faces[corner / 3][corner % 3] = vertex_of_fan[fan];
        }
    }

    /// Turn the smaller part of each piece, so that neighbours agree; one-sided pieces stay as they are.
    fn orient(&mut self) {
        let Orientation { turned, pieces, .. } = Orientation::new(&self.faces, &self.incidence());
        for Piece { faces, .. } in pieces.into_iter().filter(|piece| piece.clash.is_none()) {
            let n_turned = faces.iter().filter(|&&f| turned[f as usize]).count();
            // Of two equal parts the one with the first face stays.
            let smaller = 2 * n_turned <= faces.len();
            for f in faces.into_iter().map(|f| f as usize).filter(|&f| turned[f] == smaller) {
                self.faces[f].swap(1, 2);
                self.turned[f] = true;
                self.steps.turned_faces += 1;
            }
        }
    }

    fn take(&mut self, component: Option<usize>) -> Result<()> {
        let Some(wanted) = component else { return Ok(()) };
        let incidence = self.incidence();
        let (n, triangles) = (self.vertex_origin.len(), incidence.triangles(&self.faces));
        let pieces = components(n, triangles.clone());
        let Some(&(first, _)) = pieces.get(wanted) else {
            let value = format!("{wanted}, of {} components numbered from 0", pieces.len());
            return Err(Error::argument("component", value, "one that exists"));
        };
        let mut connected = connected(n, triangles);
        let root = connected.root(self.faces[first as usize][0]);
        let keep: Vec<bool> = self.faces.iter().map(|f| connected.root(f[0]) == root).collect();
        self.steps.faces_of_other_components = self.retain(&keep);
        Ok(())
    }

    /// Drop unused vertices and carry the attributes over.
    fn finish(mut self, soup: &Soup) -> Repaired {
        let n_before = soup.positions.len();
        let mut faces = std::mem::take(&mut self.faces);
        let used = drop_unused(self.vertex_origin.len(), &mut faces);
        let vertex_origin: Vec<u32> = used.into_iter().map(|v| self.vertex_origin[v as usize]).collect();
        let kept: HashSet<u32> = vertex_origin.iter().copied().collect();
        let gone = n_before - kept.len();
        self.steps.isolated_vertices = gone.saturating_sub(self.steps.welded_vertices);
        fn picked<T: Copy>(list: &Option<Vec<T>>, origin: &[u32]) -> Option<Vec<T>> {
            list.as_ref()?.first()?;
            list.as_ref().map(|list| origin.iter().map(|&v| list[v as usize]).collect())
        }
        fn at_corners<T: Copy>(list: &Option<Vec<[T; 3]>>, work: &Work) -> Option<Vec<[T; 3]>> {
            let mut list = picked(list, &work.origin);
            for (corners, _) in list.iter_mut().flatten().zip(&work.turned).filter(|(_, turned)| **turned) {
                corners.swap(1, 2);
            }
            list
        }
        let attributes = Attributes {
            normals: picked(&soup.attributes.normals, &vertex_origin),
            colors: picked(&soup.attributes.colors, &vertex_origin),
            corner_normals: at_corners(&soup.attributes.corner_normals, &self),
            uv: at_corners(&soup.attributes.uv, &self),
        };
        let positions: Vec<_> = vertex_origin.iter().map(|&v| soup.positions[v as usize]).collect();
        let mut diagnosis = diagnose(&positions, &faces);
        if let Some(Defect::Empty { collapsed }) = diagnosis.defects.first_mut() {
            *collapsed = self.steps.degenerate_faces;
        }
        Repaired {
            soup: Soup { positions, faces, attributes },
            vertex_origin,
            face_origin: self.origin,
            steps: self.steps,
            weld_refused: self.weld_refused,
            diagnosis,
        }
    }
}
