//! Repair of triangle lists, where it needs no guess.
//!
//! ```
//! use ricci::control::Control;
//! use ricci::mesh::io::Soup;
//! use ricci::mesh::repair::{Repair, repair};
//! let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
//! let soup = Soup::new(positions, vec![[0, 1, 2], [1, 2, 3]]); // the second face looks the other way
//! let repaired = repair(&soup, &Repair::default(), &Control::new())?;
//! assert_eq!((repaired.steps.turned_faces, repaired.diagnosis.defects.len()), (1, 0));
//! # Ok::<(), ricci::Error>(())
//! ```

use super::Point;
use super::check::{Defect, Diagnosis, Hint, Orientation, OrientedPiece, diagnose, diagnose_cut, hints};
use super::holes::{Filling, HoleChoice, fill_holes};
use super::incidence::{Incidence, NONE, components, connected, distinct, drop_unused};
use super::io::Soup;
pub use super::join::RefusedWeld;
use super::join::{join, repeats};
use super::weld::{check_tolerance, coincident};
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use std::collections::{HashMap, HashSet};

/// Options of [`repair()`]. Every repair drops faces that use a vertex twice or repeat another face, gives each fan of faces a vertex of
/// its own, turns faces until neighbours agree, and drops isolated vertices.
#[derive(Debug, Clone, PartialEq)]
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
    /// True to drop the faces of vertices whose coordinates are not finite; default false: such vertices are an error.
    pub drop_non_finite: bool,
    /// True to divide faces at vertices that lie on their boundary edges ([`Hint::TJunctions`]), before welding. Default false.
    pub split_t_junctions: bool,
    /// True to mend faces without area: where two corners nearly coincide their edge collapses; else the face goes and the one beyond its
    /// longest edge is divided at the third corner. Vertices keep their places. Faces that cannot be mended while the surface stays a
    /// manifold are left. Default false.
    pub mend_zero_area: bool,
    /// The boundary loops that are filled in the end; vertices are the input's. Default none.
    pub holes: HoleChoice,
}

impl Default for Repair {
    fn default() -> Self {
        Repair {
            weld: Some(0.0),
            cut_non_manifold_edges: false,
            component: None,
            drop_non_finite: false,
            split_t_junctions: false,
            mend_zero_area: false,
            holes: HoleChoice::Nothing,
        }
    }
}

/// The origin of an element that is new: a vertex or a face of a filled hole.
pub const NEW: u32 = u32::MAX;

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
    /// Faces dropped because a corner has no finite place.
    pub non_finite_faces: usize,
    /// Vertices put on the boundary edges on which they lie, dividing their faces.
    pub joined_t_junctions: usize,
    /// Edges collapsed because a face without area had two corners in nearly one place.
    pub collapsed_edges: usize,
    /// Faces without area replaced by dividing the face beyond their longest edge.
    pub flipped_edges: usize,
    /// Faces without area dropped at the boundary, which was their longest edge.
    pub opened_faces: usize,
}

/// A repaired triangle list, with the input's elements that its elements come from.
#[derive(Debug, Clone, PartialEq)]
pub struct Repaired {
    /// The list; its elements keep the order of the input's, and new ones follow.
    pub soup: Soup,
    /// For each vertex of the list its number in the input, [`NEW`] for those of filled holes.
    pub vertex_origin: Vec<u32>,
    /// For each face of the list the number of the input's face in which it lies, [`NEW`] in filled holes.
    pub face_origin: Vec<u32>,
    /// The repairs that were made.
    pub steps: RepairSteps,
    /// The edges because of which vertices at the same position were not all joined.
    pub weld_refused: Vec<RefusedWeld>,
    /// The loops that were filled, and those that were not, with numbers of the repaired list.
    pub filling: Filling,
    /// What was found in the list before one component was taken: pieces that welding would have joined.
    pub torn: Vec<Hint>,
    /// The remaining defects, which cannot be repaired without a guess.
    pub diagnosis: Diagnosis,
}

/// Repairs a triangle list. Attributes stay with their elements.
///
/// # Errors
///
/// [`Error::Defects`] for faces that name missing vertices and used vertices without finite coordinates, which cannot be repaired;
/// [`Error::Argument`] for a tolerance that is negative or not finite and a component that does not exist; [`Error::Cancelled`].
pub fn repair(soup: &Soup, options: &Repair, control: &Control) -> Result<Repaired> {
    refuse_garbage(soup, options.drop_non_finite)?;
    let mut work = RepairState {
        faces: soup.faces.clone(),
        origin: (0..soup.faces.len() as u32).collect(),
        turned: vec![false; soup.faces.len()],
        weights: vec![None; soup.faces.len()],
        vertex_origin: (0..soup.positions.len() as u32).collect(),
        steps: RepairSteps::default(),
        weld_refused: Vec::new(),
    };
    work.drop_non_finite(soup);
    work.drop_bad_faces();
    if options.split_t_junctions {
        work.steps.joined_t_junctions = work.split_t_junctions(&soup.positions);
    }
    control.step(Stage::Build, 0.2)?;
    let first = work.weld(soup, options.weld)?;
    work.drop_bad_faces();
    control.step(Stage::Build, 0.4)?;
    work.separate(options.cut_non_manifold_edges);
    control.check()?;
    work.orient();
    control.step(Stage::Build, 0.6)?;
    let torn = options.component.map_or_else(Vec::new, |_| work.hints(soup));
    work.take(options.component)?;
    if options.mend_zero_area {
        work.mend_zero_area(&soup.positions);
        work.separate(options.cut_non_manifold_edges);
    }
    work.sort_faces();
    control.step(Stage::Build, 0.7)?;
    let mut done = Repaired { torn, ..work.finish(soup) };
    done.fill(&options.holes, &first, control)?;
    control.step(Stage::Build, 0.9)?;
    done.diagnose();
    Ok(done)
}

impl Repaired {
    /// Fills holes. `first` has for each vertex of the input the one that it was joined with.
    fn fill(&mut self, holes: &HoleChoice, first: &[u32], control: &Control) -> Result<()> {
        let choice = match holes {
            HoleChoice::Through(named) => {
                let mut number: HashMap<u32, u32> = HashMap::new();
                for (v, &origin) in (0u32..).zip(&self.vertex_origin) {
                    number.entry(origin).or_insert(v);
                }
                let here = |v: &u32| {
                    let joined = first.get(*v as usize).copied().unwrap_or(*v);
                    let missing =
                        || Error::argument("hole", format!("vertex {v}"), "a vertex that the repair keeps");
                    number.get(v).or(number.get(&joined)).copied().ok_or_else(missing)
                };
                HoleChoice::Through(named.iter().map(here).collect::<Result<_>>()?)
            }
            other => other.clone(),
        };
        self.filling = fill_holes(&mut self.soup, &choice, control)?;
        self.vertex_origin.resize(self.soup.positions.len(), NEW);
        self.face_origin.resize(self.soup.faces.len(), NEW);
        Ok(())
    }

    fn diagnose(&mut self) {
        // The first vertex that has the origin of each.
        let mut first = HashMap::new();
        let numbered = (0u32..).zip(&self.vertex_origin);
        let uncut: Vec<u32> = numbered
            .map(|(v, &origin)| if origin == NEW { v } else { *first.entry(origin).or_insert(v) })
            .collect();
        let uncut: Vec<[u32; 3]> = self.soup.faces.iter().map(|f| f.map(|v| uncut[v as usize])).collect();
        self.diagnosis = diagnose_cut(&self.soup.positions, &self.soup.faces, &uncut);
        if let Some(Defect::Empty { collapsed }) = self.diagnosis.defects.first_mut() {
            *collapsed = self.steps.degenerate_faces;
        }
    }
}

fn is_finite(p: &Point) -> bool {
    p.iter().all(|x| x.is_finite())
}

fn refuse_garbage(soup: &Soup, drops_non_finite: bool) -> Result<()> {
    let n = soup.positions.len();
    let is_missing = |v: u32| v as usize >= n;
    let bad = |&v: &u32| is_missing(v) || !drops_non_finite && !is_finite(&soup.positions[v as usize]);
    if !soup.faces.as_flattened().iter().any(bad) {
        return Ok(());
    }
    let mut diagnosis = diagnose(&soup.positions, &soup.faces);
    let used: HashSet<u32> =
        soup.faces.as_flattened().iter().copied().filter(|&v| (v as usize) < n).collect();
    diagnosis.defects.retain(|defect| match defect.code() {
        "index_out_of_range" => true,
        "non_finite_coordinate" => !drops_non_finite && defect.vertices().iter().all(|v| used.contains(v)),
        _ => false,
    });
    Err(Error::Defects(Box::new(diagnosis)))
}

/// The corners of a face in the face that it came from, as barycentric coordinates.
pub(super) type CornerWeights = [[f64; 3]; 3];

/// A triangle list while it is repaired.
pub(super) struct RepairState {
    pub(super) faces: Vec<[u32; 3]>,
    /// For each face its number in the input, and whether it was turned.
    pub(super) origin: Vec<u32>,
    pub(super) turned: Vec<bool>,
    /// For each face that was divided where its corners lie in the input's face; these already follow its turns.
    pub(super) weights: Vec<Option<Box<CornerWeights>>>,
    /// For each vertex its number in the input.
    pub(super) vertex_origin: Vec<u32>,
    pub(super) steps: RepairSteps,
    weld_refused: Vec<RefusedWeld>,
}

impl RepairState {
    fn incidence(&self) -> Incidence {
        Incidence::new(self.vertex_origin.len(), &self.faces)
    }

    fn drop_non_finite(&mut self, soup: &Soup) {
        let keep: Vec<bool> =
            self.faces.iter().map(|f| f.iter().all(|&v| is_finite(&soup.positions[v as usize]))).collect();
        self.steps.non_finite_faces = self.retain(&keep);
    }

    fn hints(&self, soup: &Soup) -> Vec<Hint> {
        // A vertex that was divided is one here: what the repair cut open is no seam.
        let uncut: Vec<[u32; 3]> =
            self.faces.iter().map(|f| f.map(|v| self.vertex_origin[v as usize])).collect();
        hints(&soup.positions, &uncut)
    }

    /// Joins vertices; returns for each vertex the first one in its place.
    fn weld(&mut self, soup: &Soup, tolerance: Option<f64>) -> Result<Vec<u32>> {
        let Some(tolerance) = tolerance else { return Ok((0..soup.positions.len() as u32).collect()) };
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
        Ok(first)
    }

    /// Drops the faces for which `keep` is false; returns their number.
    pub(super) fn retain(&mut self, keep: &[bool]) -> usize {
        let before = self.faces.len();
        fn chosen<T>(list: &mut Vec<T>, keep: &[bool]) {
            let mut flags = keep.iter();
            list.retain(|_| flags.next().copied().unwrap_or(false));
        }
        chosen(&mut self.faces, keep);
        chosen(&mut self.origin, keep);
        chosen(&mut self.turned, keep);
        chosen(&mut self.weights, keep);
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
                match &mut self.weights[f] {
                    Some(weights) => weights.swap(1, 2),
                    None => self.turned[f] = true,
                }
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
        self.steps.isolated_vertices =
            gone.saturating_sub(self.steps.welded_vertices + self.steps.collapsed_edges);
        let mut attributes = soup.attributes.of_origins(&vertex_origin, &self.origin);
        attributes.corner_normals = self.at_corners(attributes.corner_normals.take());
        attributes.uv = self.at_corners(attributes.uv.take());
        let positions: Vec<_> = vertex_origin.iter().map(|&v| soup.positions[v as usize]).collect();
        Repaired {
            soup: Soup { positions, faces, attributes },
            vertex_origin,
            face_origin: self.origin,
            steps: self.steps,
            weld_refused: self.weld_refused,
            filling: Filling::default(),
            torn: Vec::new(),
            diagnosis: Diagnosis::default(),
        }
    }

    /// Values at the corners of each face's origin as values at its own corners.
    fn at_corners<const N: usize>(&self, list: Option<Vec<[[f64; N]; 3]>>) -> Option<Vec<[[f64; N]; 3]>> {
        let mut list = list?;
        for (f, corners) in list.iter_mut().enumerate() {
            if let Some(weights) = &self.weights[f] {
                let given = *corners;
                let mean = |w: [f64; 3]| {
                    std::array::from_fn(|x| w[0] * given[0][x] + w[1] * given[1][x] + w[2] * given[2][x])
                };
                *corners = weights.map(mean);
            } else if self.turned[f] {
                corners.swap(1, 2);
            }
        }
        Some(list)
    }
}
