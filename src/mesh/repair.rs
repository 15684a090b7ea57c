//! Repair of triangle lists, where it needs no guess.
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

use super::check::{Defect, Diagnosis, Orientation, OrientedPiece, diagnose};
use super::incidence::{Incidence, NONE, components, connected, distinct, drop_unused};
use super::io::Soup;
pub use super::join::RefusedWeld;
use super::join::{join, repeats};
use super::weld::{check_tolerance, coincident};
use crate::error::{Error, Result};
use std::collections::HashSet;

/// Options of [`repair()`]. Every repair drops faces that use a vertex twice or repeat another face, gives each fan of faces a vertex of
/// its own, turns faces until neighbours agree, and drops isolated vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Repair {
    /// Vertices within this distance are joined (transitively; the position of the first one stays). 0 joins vertices at exactly the same
    /// position where their faces are then connected through edges, except in edges in which more than two faces would meet
    /// ([`Repaired::weld_refused`]). `None` joins none. Default 0.
    pub weld: Option<f64>,
    /// True to cut the surface open along edges in which more than two faces meet. Default false: which faces belong together would be a
    /// guess.
    pub cut_non_manifold_edges: bool,
    /// The connected piece to keep; 0 is the one with the most faces, and so on. Default all.
    pub component: Option<usize>,
}

impl Default for Repair {
    fn default() -> Self {
        Repair { weld: Some(0.0), cut_non_manifold_edges: false, component: None }
    }
}

/// The number of times that each kind of repair was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RepairSteps {
    /// Vertices that became one with an earlier vertex.
    pub welded_vertices: usize,
    /// Faces dropped because they used a vertex twice (after welding).
    pub degenerate_faces: usize,
    /// Faces dropped because an earlier face had their vertices.
    pub duplicate_faces: usize,
    /// Edges along which the surface was cut open.
    pub cut_edges: usize,
    /// Vertices added for further fans of faces.
    pub split_vertices: usize,
    /// Faces turned around.
    pub turned_faces: usize,
    /// Faces dropped because they belong to other components than the one to keep.
    pub faces_of_other_components: usize,
    /// Vertices dropped because no face uses them.
    pub isolated_vertices: usize,
}

/// A repaired triangle list, with the input's elements that its elements come from.
#[derive(Debug, Clone, PartialEq)]
pub struct Repaired {
    /// The list; its elements keep the order of the input's.
    pub soup: Soup,
    /// For each vertex of the list its number in the input.
    pub vertex_origin: Vec<u32>,
    /// For each face of the list its number in the input.
    pub face_origin: Vec<u32>,
    /// The repairs that were made.
    pub steps: RepairSteps,
    /// The edges because of which vertices at the same position were not all joined.
    pub weld_refused: Vec<RefusedWeld>,
    /// The remaining defects, which cannot be repaired without a guess.
    pub diagnosis: Diagnosis,
}

/// Repairs a triangle list. Attributes stay with their elements.
///
/// # Errors
///
/// [`Error::Defects`] for faces that name missing vertices and used vertices without finite coordinates, which cannot be repaired;
/// [`Error::Argument`] for a tolerance that is negative or not finite and a component that does not exist.
pub fn repair(soup: &Soup, options: &Repair) -> Result<Repaired> {
    refuse_garbage(soup)?;
    let mut work = RepairState {
        faces: soup.faces.clone(),
        origin: (0..soup.faces.len() as u32).collect(),
        turned: vec![false; soup.faces.len()],
        vertex_origin: (0..soup.positions.len() as u32).collect(),
        steps: RepairSteps::default(),
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

/// A triangle list while it is repaired.
struct RepairState {
    faces: Vec<[u32; 3]>,
    /// For each face its number in the input, and whether it was turned.
    origin: Vec<u32>,
    turned: Vec<bool>,
    /// For each vertex its number in the input.
    vertex_origin: Vec<u32>,
    steps: RepairSteps,
    weld_refused: Vec<RefusedWeld>,
}

impl RepairState {
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

    /// Drops the faces for which `keep` is false; returns their number.
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

    /// Gives every fan of faces a vertex of its own. With `cut`, edges with more than two faces do not connect a fan.
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

    /// Turns the smaller part of each piece, so that neighbours agree; one-sided pieces stay as they are.
    fn orient(&mut self) {
        let Orientation { turned, pieces, .. } = Orientation::new(&self.faces, &self.incidence());
        for OrientedPiece { faces, .. } in pieces.into_iter().filter(|piece| piece.clash.is_none()) {
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

    /// Drops unused vertices and takes over the attributes.
    fn finish(mut self, soup: &Soup) -> Repaired {
        let n_before = soup.positions.len();
        let mut faces = std::mem::take(&mut self.faces);
        let used = drop_unused(self.vertex_origin.len(), &mut faces);
        let vertex_origin: Vec<u32> = used.into_iter().map(|v| self.vertex_origin[v as usize]).collect();
        let kept: HashSet<u32> = vertex_origin.iter().copied().collect();
        let gone = n_before - kept.len();
        self.steps.isolated_vertices = gone.saturating_sub(self.steps.welded_vertices);
        let mut attributes = soup.attributes.of_origins(&vertex_origin, &self.origin);
        let turned = |f: &usize| self.turned[*f];
        for f in (0..faces.len()).filter(turned) {
            attributes.corner_normals.iter_mut().for_each(|corners| corners[f].swap(1, 2));
            attributes.uv.iter_mut().for_each(|corners| corners[f].swap(1, 2));
        }
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
