//! Developing a surface of constant curvature into its model space, face by face.

use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::motion::Real;
use crate::geometry::{Motion, Space, Twofold};
use crate::mesh::{FaceId, HalfedgeId, Mesh, PerEdge, PerFace, PerHalfedge, VertexId};
use crate::metric::Metric;
use crate::metric::precise::half_angles;
use crate::topology::CutGraph;
use crate::topology::spanning::Key;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Faces between two looks at the control.
const FACES_PER_STEP: usize = 4096;

/// An isometry with twice the digits of doubles: what a layout loses is magnified by e^distance in H².
type Frame = Motion<Twofold>;

/// The triangles of a metric, each by itself.
pub(super) struct Faces<'a> {
    pub mesh: &'a Mesh,
    pub space: Space,
    pub differences: PerFace<[f64; 3]>,
    /// `[cos, sin]` of half the angle at each corner.
    half_angles: PerFace<[[Twofold; 2]; 3]>,
    /// Per edge the a and b of the translation along it ([`Motion::translation_of_chord`]).
    steps: PerEdge<[Twofold; 2]>,
}

/// Where every face lies.
pub(super) struct Grown {
    /// Per face, the isometry that brings its first corner from the origin, with its first side along x, to where it lies.
    pub frames: PerFace<Frame>,
    /// Faces in the order in which they were added, each with the half-edge it was entered through.
    pub order: Vec<HalfedgeId>,
    /// Edges through which a face was entered.
    pub crossed: PerEdge<bool>,
}

impl<'a> Faces<'a> {
    pub fn new(mesh: &'a Mesh, metric: &Metric) -> Result<Faces<'a>> {
        let chords = metric.half_chords(mesh)?;
        let half_angles = half_angles(metric, mesh, &metric.scaled_chords(mesh)?);
        let differences = metric.differences(mesh)?;
        let step = |&chord: &Twofold| [Motion::translation_of_chord(chord, metric.space).a[0], chord];
        let steps = chords.iter().map(step).collect::<Vec<_>>().into();
        Ok(Faces { mesh, space: metric.space, differences, half_angles, steps })
    }

    /// Whether the lengths break the triangle inequality.
    pub fn is_broken(&self, f: FaceId) -> bool {
        self.half_angles[f].iter().all(|[cos, sin]| cos.high == 0.0 || sin.high == 0.0)
    }

    /// Add face after face to the one at `root`, next the one whose far corner is nearest to it; over no edge of the `cut`.
    pub fn grow(&self, root: VertexId, cut: Option<&CutGraph>, control: &Control) -> Result<Grown> {
        let mesh = self.mesh;
        let Some(first) = mesh.outgoing(root).find(|&h| !mesh.is_outside(h)) else {
            return Err(Error::Layout(format!("vertex {root} has no face")));
        };
        let mut grown = Grown {
            frames: PerFace::filled(mesh.n_faces(), Motion::identity(self.space)),
            order: Vec::with_capacity(mesh.n_faces()),
            crossed: PerEdge::filled(mesh.n_edges(), false),
        };
        let mut done = PerFace::filled(mesh.n_faces(), false);
        let mut queue = BinaryHeap::from([Reverse((Key(0.0), first))]);
        while let Some(Reverse((_, entry))) = queue.pop() {
            let Some(f) = mesh.face(entry).filter(|&f| !std::mem::replace(&mut done[f], true)) else {
                continue;
            };
            if grown.order.len().is_multiple_of(FACES_PER_STEP) {
                control.step(Stage::Layout, grown.order.len() as f64 / mesh.n_faces() as f64)?;
            }
            let frame = match entry == first {
                true => Motion::identity(self.space),
                false => {
                    grown.crossed[entry.edge()] = true;
                    self.across(&self.frame(&grown.frames, entry.twin()), entry)
                }
            };
            grown.frames[f] = self.turned_to_first(&frame, entry);
            grown.order.push(entry);
            let mut side = entry;
            let mut frame = frame;
            for _ in 0..3 {
                let across = side.twin();
                let open = cut.is_none_or(|cut| !cut.is_cut[side.edge()]);
                if open && mesh.face(across).is_some_and(|g| !done[g]) {
                    // The order needs no more than doubles.
                    let [x, y] = self.apex(&self.across(&frame.rounded(), across), across).b;
                    if !(x.is_finite() && y.is_finite()) {
                        return Err(Error::Layout(format!(
                            "edge {} lies beyond the range of doubles",
                            side.edge()
                        )));
                    }
                    queue.push(Reverse((Key(x.hypot(y)), across)));
                }
                frame = self.along(&frame, side);
                side = mesh.next(side);
            }
        }
        if grown.order.len() < mesh.n_faces() {
            return Err(Error::Layout("the surface has several components: lay out each alone".into()));
        }
        Ok(grown)
    }

    /// Ambient coordinates per number of a corner: each from the first of its faces that was added.
    pub fn place(&self, grown: &Grown, corner: &PerHalfedge<u32>, n_corners: usize) -> Vec<[f64; 3]> {
        let mut points = vec![[f64::NAN; 3]; n_corners];
        for &entry in &grown.order {
            let frame = self.frame(&grown.frames, entry);
            let apex = self.mesh.prev(entry);
            let tip = self.mesh.next(entry);
            for (h, motion) in
                [(entry, frame), (tip, self.along(&frame, entry)), (apex, self.apex(&frame, entry))]
            {
                let point = &mut points[corner[h] as usize];
                if point[0].is_nan() {
                    *point = motion.origin().map(f64::from);
                }
            }
        }
        points
    }

    /// The frame of a half-edge inside the surface: its origin from 0, itself from the x axis.
    pub fn frame(&self, frames: &PerFace<Frame>, h: HalfedgeId) -> Frame {
        match self.mesh.face(h) {
            Some(f) => self.frame_in(&frames[f], h),
            None => Motion::identity(self.space),
        }
    }

    /// The frame of a half-edge of a face, from that of the face's first half-edge.
    pub fn frame_in(&self, first: &Frame, h: HalfedgeId) -> Frame {
        self.mesh.face(h).map_or(*first, |f| self.walked(first, self.mesh.face_halfedge(f), h))
    }

    /// Ambient coordinates of a face's corners, in its corner order, from the frame of its first half-edge.
    pub fn corners(&self, f: FaceId, first: &Frame) -> [[f64; 3]; 3] {
        self.mesh.face_halfedges(f).map(|h| self.frame_in(first, h).origin().map(f64::from))
    }

    /// The frame of the first half-edge of the face of `h`, from that of `h`.
    pub fn turned_to_first(&self, frame: &Frame, h: HalfedgeId) -> Frame {
        self.mesh.face(h).map_or(*frame, |f| self.walked(frame, h, self.mesh.face_halfedge(f)))
    }

    /// The frame of the half-edge `to`, from that of another one of its face.
    fn walked(&self, frame: &Frame, from: HalfedgeId, to: HalfedgeId) -> Frame {
        let (mut frame, mut at) = (*frame, from);
        while at != to {
            frame = self.along(&frame, at);
            at = self.mesh.next(at);
        }
        frame
    }

    /// What a walk from one half-edge to another does to a frame: through the half-edges `crossed`, each of the face one is in.
    pub fn transport(&self, from: HalfedgeId, crossed: &[HalfedgeId], to: HalfedgeId) -> Frame {
        let (mut frame, mut at) = (Motion::identity(self.space), from);
        for &h in crossed {
            frame = self.across(&self.walked(&frame, at, h), h.twin());
            at = h.twin();
        }
        self.walked(&frame, at, to)
    }

    /// The frame of `across`, the twin of the half-edge with this frame.
    pub fn across<T: Real + From<Twofold>>(&self, frame: &Motion<T>, across: HalfedgeId) -> Motion<T> {
        let half_turn = [0.0, 1.0].map(T::from);
        frame.after_translation(self.step(across)).after_rotation(half_turn)
    }

    /// The frame of the next half-edge of the face.
    fn along<T: Real + From<Twofold>>(&self, frame: &Motion<T>, h: HalfedgeId) -> Motion<T> {
        let [cos, sin] = self.half_angle(self.mesh.next(h));
        frame.after_translation(self.step(h)).after_rotation([sin, cos]) // by π − θ
    }

    /// What brings the origin to the corner opposite `h`, from that end of `h` which is nearer to the origin.
    pub fn apex<T: Real + From<Twofold>>(&self, frame: &Motion<T>, h: HalfedgeId) -> Motion<T> {
        let tip = self.along(frame, h);
        let far = |m: &Motion<T>| -> f64 { m.b[0].into().hypot(m.b[1].into()) };
        match far(frame) <= far(&tip) {
            true => frame.after_rotation(self.half_angle(h)).after_translation(self.step(self.mesh.prev(h))),
            false => tip.after_translation(self.step(self.mesh.next(h))),
        }
    }

    /// The translation along an edge.
    fn step<T: From<Twofold>>(&self, h: HalfedgeId) -> [T; 2] {
        self.steps[h.edge()].map(T::from)
    }

    /// `[cos, sin]` of half the angle at the origin of `h` in its face.
    fn half_angle<T: From<Twofold>>(&self, h: HalfedgeId) -> [T; 2] {
        let Some(f) = self.mesh.face(h) else { return [Twofold::from(1.0), 0.0.into()].map(T::from) };
        let corner = self.mesh.face_halfedges(f).iter().position(|&x| x == h).unwrap_or(0);
        self.half_angles[f][corner].map(T::from)
    }
}
