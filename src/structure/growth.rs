//! Charts that grow from a face as long as they stay embedded, with the neighbouring faces that they share.

use super::developable::DevelopableSurface;
use super::draft::ChartDraft;
use super::stars::star;
use crate::control::{Control, Stage};
use crate::error::Result;
use crate::geometry::model::distance;
use crate::geometry::triangle_flatness::{TriangleFlatness, largest_coordinate};
use crate::geometry::triangle_overlap::BoxTree;
use crate::geometry::vector::{norm, sub};
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::{FaceId, HalfedgeId, PerFace, PerVertex, VertexId};
use crate::topology::spanning::Key;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap, VecDeque};

/// Most faces of the first attempt at a chart.
const FIRST: usize = 256;
/// Factor of the number of faces for the next attempt, if all are embedded.
const MORE: usize = 4;
/// Factor within which, in E², the longest sides of a chart's faces are to that of the first face: coordinates of all of them then have ten
/// digits relative to the smallest.
const RANGE: f64 = 1e3;

/// A face that may be added to a chart, with its place, and the face of the chart and sides across which it was reached.
struct CandidateFace {
    face: FaceId,
    place: Motion<DoubleDouble>,
    parent: Option<(u32, usize, usize)>,
}

/// The construction of charts that grow, each with a core of faces that are in no other core.
pub(super) struct AtlasCover<'a> {
    surface: &'a DevelopableSurface,
    /// Largest distance of a core's corners from its origin, in units of the radius of curvature; infinite in E².
    radius: f64,
    /// True for faces in the core of a chart, and for excluded ones.
    taken: PerFace<bool>,
    control: &'a Control,
}

impl<'a> AtlasCover<'a> {
    /// No charts yet; the default of `radius` is that of [`super::AtlasOptions::radius`].
    pub fn new(surface: &'a DevelopableSurface, radius: Option<f64>, control: &'a Control) -> Self {
        let radius = radius.unwrap_or_else(|| usual_radius(surface));
        AtlasCover { surface, radius, taken: surface.excluded.clone(), control }
    }

    /// Charts whose cores cover the surface, each face in one core, then the stars of those regular vertices that are inside none of them.
    pub fn cover(mut self) -> Result<Vec<ChartDraft>> {
        let (mesh, mut drafts) = (self.surface.mesh(), Vec::new());
        for f in mesh.faces() {
            if !self.taken[f] {
                self.control.step(Stage::Layout, f.index() as f64 / mesh.n_faces() as f64)?;
                drafts.push(self.patch(f)?);
            }
        }
        let mut inside = PerVertex::filled(mesh.n_vertices(), false);
        drafts.iter().for_each(|draft| mark_inside(self.surface, draft, &mut inside));
        for v in mesh.vertices().filter(|&v| !inside[v] && !self.surface.singular[v]) {
            drafts.extend(star(self.surface, v));
        }
        Ok(drafts)
    }

    /// Charts over the faces that no star has.
    pub fn cover_rest(mut self, stars: &[ChartDraft]) -> Result<Vec<ChartDraft>> {
        stars.iter().flat_map(|draft| &draft.faces).for_each(|&f| self.taken[f] = true);
        let rest: Vec<FaceId> = self.surface.mesh().faces().filter(|&f| !self.taken[f]).collect();
        let mut drafts = Vec::new();
        for f in rest {
            if !self.taken[f] {
                drafts.push(self.patch(f)?);
            }
        }
        Ok(drafts)
    }

    /// The chart that grows from a face over faces not taken, ordered by the distance of their far corners, and the faces around its core
    /// that keep it embedded.
    fn patch(&mut self, seed: FaceId) -> Result<ChartDraft> {
        let mut limit = FIRST;
        let mut all = loop {
            let mut grown = self.grow(seed, limit);
            let kept = self.embedded(&grown, 1)?.iter().take_while(|&&fits| fits).count();
            if kept < limit {
                grown.truncate(kept);
                break grown;
            }
            limit *= MORE;
        };
        let n_core = all.len();
        all.iter().for_each(|candidate| self.taken[candidate.face] = true);
        self.collar(&mut all);
        let kept = self.embedded(&all, n_core)?;
        Ok(ChartDraft { n_core, ..assemble(self.surface, &all, &kept) })
    }

    /// Up to `limit` faces about a seed that are not taken, each once, nearest first.
    fn grow(&self, seed: FaceId, limit: usize) -> Vec<CandidateFace> {
        let (surface, mesh) = (self.surface, self.surface.mesh());
        let mut grown: Vec<CandidateFace> = Vec::new();
        let mut seen = BTreeSet::from([seed]);
        let mut closing: BTreeMap<u32, usize> = BTreeMap::new();
        let mut queue = BinaryHeap::new();
        let mut waiting: Vec<Option<CandidateFace>> = Vec::new();
        let first = CandidateFace { face: seed, place: surface.place_about(seed, None), parent: None };
        let (size, mut next) = (self.size(seed), Some(first));
        while let Some(candidate) = next {
            let number = grown.len() as u32;
            let face = candidate.face;
            grown.push(candidate);
            if grown.len() == limit {
                break;
            }
            for (k, h) in mesh.face_halfedges(face).into_iter().enumerate() {
                let beyond = mesh.corner(h.twin()).filter(|(g, _)| !self.taken[*g] && !seen.contains(g));
                let Some((g, l)) = beyond.filter(|(g, _)| within(self.size(*g), size)) else { continue };
                if let Some((candidate, far)) = self.beyond(&grown[number as usize], (number, k, l), h, g) {
                    queue.push(Reverse((Key(far), waiting.len())));
                    waiting.push(Some(candidate));
                }
            }
            next = loop {
                let Some(Reverse((_, at))) = queue.pop() else { break None };
                let Some(candidate) = waiting[at].take() else { continue };
                if seen.contains(&candidate.face) || self.surrounds(&mut closing, candidate.face) {
                    continue;
                }
                seen.insert(candidate.face);
                break Some(candidate);
            };
        }
        grown
    }

    /// True if a face would be the last one around a singular vertex; otherwise it is counted there.
    fn surrounds(&self, count: &mut BTreeMap<u32, usize>, f: FaceId) -> bool {
        let mesh = self.surface.mesh();
        let singular: Vec<_> =
            mesh.face_vertices(f).into_iter().filter(|&v| self.surface.singular[v]).collect();
        let is_last = |v: &VertexId| count.get(&v.0).copied().unwrap_or(0) + 1 >= mesh.outgoing(*v).count();
        if singular.iter().any(is_last) {
            return true;
        }
        singular.iter().for_each(|v| *count.entry(v.0).or_insert(0) += 1);
        false
    }

    /// The face beyond a half-edge of a candidate, with the distance of its farthest corner; none beyond the radius.
    fn beyond(
        &self,
        from: &CandidateFace,
        parent: (u32, usize, usize),
        h: HalfedgeId,
        face: FaceId,
    ) -> Option<(CandidateFace, f64)> {
        let place = from.place.compose(&self.surface.faces.across[h]);
        let (space, corners) = (self.surface.faces.space, self.surface.corners(face, &place));
        let far = corners.iter().map(|&[x, y, w]| match space {
            Space::S2 => w.clamp(-1.0, 1.0).acos(),
            Space::H2 => x.hypot(y).asinh(),
            Space::E2 => x.hypot(y),
        });
        let far = far.fold(0.0, f64::max);
        let is_near = space == Space::E2 || far <= self.radius;
        is_near.then_some((CandidateFace { face, place, parent: Some(parent) }, far))
    }

    /// The length of a face's longest side in E²; elsewhere 1, since the radius bounds charts there.
    fn size(&self, f: FaceId) -> f64 {
        if self.surface.faces.space != Space::E2 {
            return 1.0;
        }
        TriangleFlatness::of(self.surface.faces.corners[f].map(|[x, y, _]| [x, y])).longest
    }

    /// For each candidate, true if it is kept: it is counterclockwise, does not overlap those kept before it, and was reached from a kept
    /// one. The first `n_sure` are always kept. Faces that have no area beyond rounding overlap nothing.
    fn embedded(&self, all: &[CandidateFace], n_sure: usize) -> Result<Vec<bool>> {
        let whole = assemble(self.surface, all, &vec![true; all.len()]);
        // If some face has no straight coordinates, only the sure ones are kept.
        let Some(triangles) = whole.triangles(self.surface) else {
            return Ok((0..all.len()).map(|i| i < n_sure).collect());
        };
        let size = largest_coordinate(triangles.as_flattened());
        let mut tree = BoxTree::new(&triangles, self.control)?;
        let mut kept: Vec<bool> = Vec::with_capacity(all.len());
        for (i, &triangle) in triangles.iter().enumerate() {
            let flatness = TriangleFlatness::of(triangle);
            let (flat, flipped) = (flatness.is_degenerate(size), flatness.is_flipped(size));
            let hangs = all[i].parent.is_none_or(|(parent, _, _)| kept[parent as usize]);
            let fits = i < n_sure || (hangs && !flipped && (flat || tree.meeting(i).is_none()));
            if fits && !flat && !flipped {
                tree.insert(i);
            }
            kept.push(fits);
        }
        Ok(kept)
    }

    /// Adds the faces that touch the vertices of a core, whether another core has them or not.
    fn collar(&self, all: &mut Vec<CandidateFace>) {
        let (surface, mesh) = (self.surface, self.surface.mesh());
        let mut seen: BTreeSet<FaceId> = all.iter().map(|candidate| candidate.face).collect();
        let core: BTreeSet<_> = seen.iter().flat_map(|&f| mesh.face_vertices(f)).collect();
        let size = all.first().map_or(1.0, |first| self.size(first.face));
        let mut count = BTreeMap::new();
        for &f in &seen {
            self.surrounds(&mut count, f);
        }
        let mut open: VecDeque<u32> = (0..all.len() as u32).collect();
        while let Some(i) = open.pop_front() {
            for (k, h) in mesh.face_halfedges(all[i as usize].face).into_iter().enumerate() {
                let Some((g, l)) = mesh.corner(h.twin()) else { continue };
                let touches = core.contains(&mesh.origin(h)) || core.contains(&mesh.tip(h));
                let fits = touches && !surface.excluded[g] && !seen.contains(&g);
                if !fits || !within(self.size(g), size) || self.surrounds(&mut count, g) {
                    continue;
                }
                let place = all[i as usize].place.compose(&surface.faces.across[h]);
                seen.insert(g);
                open.push_back(all.len() as u32);
                all.push(CandidateFace { face: g, place, parent: Some((i, k, l)) });
            }
        }
    }
}

/// The chart of the candidates that are kept.
fn assemble(surface: &DevelopableSurface, all: &[CandidateFace], kept: &[bool]) -> ChartDraft {
    let (mut draft, mut number) = (ChartDraft::default(), vec![0; all.len()]);
    for (i, candidate) in all.iter().enumerate().filter(|(i, _)| kept[*i]) {
        number[i] = draft.push(candidate.face, candidate.place);
        if let Some((parent, k, l)) = candidate.parent {
            draft.join((number[parent as usize], k), (number[i], l));
        }
    }
    draft.close(surface);
    draft
}

/// The default radius: three times the median of the longest sides of the triangles, clamped to what a disk or a plane shows well.
fn usual_radius(surface: &DevelopableSurface) -> f64 {
    let most = match surface.faces.space {
        Space::E2 => return f64::INFINITY,
        Space::S2 => 0.8,
        Space::H2 => 3.0,
    };
    let longest = |corners: &[[f64; 3]; 3]| {
        let side = |k: usize| match surface.faces.space {
            Space::H2 => distance(corners[k], corners[(k + 1) % 3]),
            _ => 2.0 * (0.5 * norm(sub(corners[k], corners[(k + 1) % 3]))).asin(),
        };
        (0..3).map(side).fold(0.0, f64::max)
    };
    let mut sides: Vec<f64> = surface.faces.corners.iter().map(longest).collect();
    sides.sort_by(f64::total_cmp);
    let median = sides.get(sides.len() / 2).copied().unwrap_or(0.0);
    (3.0 * median).clamp(0.5, most)
}

fn within(size: f64, first: f64) -> bool {
    size <= RANGE * first && first <= RANGE * size
}

/// Marks the vertices all of whose faces lie around one vertex of a chart.
fn mark_inside(surface: &DevelopableSurface, draft: &ChartDraft, inside: &mut PerVertex<bool>) {
    let mut count = vec![0usize; draft.vertices.len()];
    draft.corners.iter().flatten().for_each(|&v| count[v as usize] += 1);
    for (&v, &count) in draft.vertices.iter().zip(&count) {
        let mesh = surface.mesh();
        inside[v] |= mesh.outgoing(v).filter(|&h| !mesh.is_outside(h)).count() == count;
    }
}
