//! STEP files (AP242) of tensor-product patches: closed parts as solids, open ones as shells, with common edges and vertices.

mod geometry;
mod patches;
mod planes;
mod shells;

use crate::error::{Error, Result};
use geometry::{
    Authored, FaceSurface, ParameterPlane, add_curve, add_cylinder, add_plane, add_point, add_surface,
};
pub(super) use geometry::{StepCurveGeometry, StepSurfaceGeometry};
use patches::Side;
pub(super) use patches::{PatchCylinder, StepCurve, StepPart, StepPatch, StepPatches};
use planes::{FlatFace, flat_faces};
use shells::add_shells;
use std::collections::BTreeMap;
use std::io::Write;
use step_io::build::{StyleTarget, UnitsInput};
use step_io::model as m;
use step_io::scene::Rgb;
use step_io::{Ap242Author, StepBuilder, StepModel};

/// The time stamp of every file: fixed, so that the same patches give the same bytes.
const TIME_STAMP: &str = "2000-01-01T00:00:00Z";
/// Distance, over the diagonal, below which a reader may take two points as one. Common curves and points agree to the last bit.
const UNCERTAINTY: f64 = 1e-7;

/// The colours of faces, as red, green and blue in [0, 1]: five suffice where at most four patches lie beside one.
const COLOURS: [[f64; 3]; 5] =
    [[0.55, 0.70, 0.86], [0.95, 0.76, 0.50], [0.63, 0.80, 0.58], [0.87, 0.62, 0.62], [0.76, 0.68, 0.84]];

/// The unit of the coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LengthUnit {
    /// Millimetres.
    #[default]
    Millimetre,
    /// Metres.
    Metre,
}

/// Options of STEP files.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StepOptions {
    /// The name of the part.
    pub name: String,
    /// The unit of the coordinates.
    pub unit: LengthUnit,
    /// True: faces have colours that differ from those of their neighbours, so that programs show the patches. By default they have none.
    pub colours: bool,
}

impl StepPatches<'_> {
    /// Writes the patches as STEP AP242. Each part that closes up becomes a solid with outward normals; the others become shells of one
    /// surface model. The same patches give the same bytes.
    ///
    /// # Errors
    /// [`Error::Spline`] for patches that cannot be written; [`Error::Io`], without a path, if writing to `out` fails.
    pub fn write(&self, options: &StepOptions, out: &mut impl Write) -> Result<()> {
        let model = self.model(options).map_err(|why| {
            let message = format!("they cannot be written as STEP: {why}");
            Error::Spline { what: "patches", index: 0, message }
        })?;
        step_io::write(&model, out).map_err(|why| Error::Io { path: "STEP".into(), message: why.to_string() })
    }

    fn model(&self, options: &StepOptions) -> Authored<StepModel> {
        let length = match options.unit {
            LengthUnit::Millimetre => step_io::build::LengthUnit::Millimetre,
            LengthUnit::Metre => step_io::build::LengthUnit::Metre,
        };
        let units = UnitsInput { length, uncertainty: UNCERTAINTY * self.diagonal };
        let mut builder = StepBuilder::new_with(&units)?;
        let header = builder.header_mut();
        header.time_stamp = TIME_STAMP.into();
        header.file_name.clone_from(&options.name);
        header.originating_system = concat!("ricci ", env!("CARGO_PKG_VERSION")).into();
        let part = builder.part(&options.name);
        let flat = self.flat_faces();
        let surfaces = self.surfaces(builder.author(), &flat)?;
        let edges = self.edges(builder.author(), &surfaces, &flat)?;
        let colours = if options.colours { self.colours() } else { Vec::new() };
        let mut flat_of = vec![None; self.patches.len()];
        flat.iter().for_each(|face| face.patches.iter().for_each(|&p| flat_of[p] = Some(face)));
        let mut open = Vec::new();
        for part_of in &self.parts {
            let mut faces = Vec::with_capacity(part_of.patches.len());
            for &at in &part_of.patches {
                let (name, loops) = match flat_of[at] {
                    None => {
                        let kind = if self.patches[at].cylinder.is_some() { "cylinder" } else { "patch" };
                        (format!("{kind} {at}"), vec![self.patches[at].sides.to_vec()])
                    }
                    Some(face) if face.patches[0] == at => (format!("plane {at}"), face.loops.clone()),
                    Some(_) => continue,
                };
                let face = FaceOnSurface { surface: surfaces[at], loops, is_inverted: part_of.is_inverted };
                let face = add_face(builder.author(), &name, &face, &edges)?;
                if let Some([red, green, blue]) = colours.get(at).map(|&k| COLOURS[k]) {
                    builder.style(StyleTarget::Face(face), Rgb { red, green, blue }, None)?;
                }
                faces.push(face);
            }
            if part_of.is_closed {
                builder.solid(part, &options.name, faces)?;
            } else {
                open.push(faces);
            }
        }
        if !open.is_empty() {
            add_shells(&mut builder, part, open, &options.name, &units)?;
        }
        Ok(builder.finish())
    }

    /// The number of faces of the file.
    pub fn n_faces(&self) -> usize {
        self.flat_faces().iter().fold(self.patches.len(), |n, face| n + 1 - face.patches.len())
    }

    /// The faces on planes.
    fn flat_faces(&self) -> Vec<FlatFace> {
        if self.planes { flat_faces(self, UNCERTAINTY * self.diagonal) } else { Vec::new() }
    }

    /// Adds the surface of each patch; those of one face on a plane have one.
    fn surfaces(&self, author: &mut Ap242Author, flat: &[FlatFace]) -> Authored<Vec<FaceSurface>> {
        let mut planes = vec![None; self.patches.len()];
        for face in flat {
            let plane = add_plane(author, face.plane)?;
            face.patches.iter().for_each(|&p| planes[p] = Some(plane));
        }
        let surface = |(plane, patch): (Option<m::PlaneId>, &StepPatch)| match (plane, &patch.cylinder) {
            (Some(plane), _) => Ok(FaceSurface::Plane(plane)),
            (None, Some(PatchCylinder { cylinder, middle, is_hollow })) => {
                let id = add_cylinder(author, cylinder, middle.map(|x| -x))?;
                Ok(FaceSurface::Cylinder(id, *is_hollow))
            }
            (None, None) => add_surface(author, &patch.surface).map(FaceSurface::Spline),
        };
        planes.into_iter().zip(&self.patches).map(surface).collect()
    }

    /// Adds an edge for each curve that is a side of a face, with the curves in the parameters of the patches beside it: a reader that had to find
    /// those by projection would take the wrong side of a thin patch. On a plane or a cylinder it finds the right ones.
    fn edges(
        &self,
        author: &mut Ap242Author,
        surfaces: &[FaceSurface],
        flat: &[FlatFace],
    ) -> Authored<BTreeMap<usize, m::EdgeCurveId>> {
        let plane = ParameterPlane::add(author)?;
        let is_side = self.are_sides(flat);
        let mut vertices = vec![None; self.points.len()];
        let beside = self.beside();
        let mut edges = BTreeMap::new();
        for at in (0..self.curves.len()).filter(|&at| is_side[at]) {
            let (StepCurve { ends, is_crease, curve }, beside) = (&self.curves[at], &beside[at]);
            let mut lines = Vec::with_capacity(2);
            for &(at, side) in beside {
                lines.push(match surfaces[at] {
                    FaceSurface::Plane(id) => m::PcurveOrSurfaceRef::Plane(id),
                    FaceSurface::Cylinder(id, _) => m::PcurveOrSurfaceRef::CylindricalSurface(id),
                    FaceSurface::Spline(id) => {
                        let StepPatch { surface, sides, .. } = &self.patches[at];
                        let along = surface.side(side, sides[side].1);
                        m::PcurveOrSurfaceRef::Pcurve(plane.add_line(author, id, curve.domain(), along)?)
                    }
                });
            }
            let curve = add_curve(author, curve)?;
            let by = m::PreferredSurfaceCurveRepresentation::Curve3d;
            let is_seam = beside.len() == 2 && beside[0].0 == beside[1].0;
            let on_surfaces = match is_seam {
                true => m::CurveRef::SeamCurve(author.add_seam_curve("", curve, lines, by)?),
                false => m::CurveRef::SurfaceCurve(author.add_surface_curve("", curve, lines, by)?),
            };
            let mut vertex = |p: u32| match vertices[p as usize] {
                Some(known) => Ok(known),
                None => self.add_vertex(author, p).inspect(|&new| vertices[p as usize] = Some(new)),
            };
            let [from, to] = [vertex(ends[0])?, vertex(ends[1])?].map(m::VertexRef::VertexPoint);
            let name = if *is_crease { "crease" } else { "" };
            edges.insert(at, author.add_edge_curve(name, from, to, on_surfaces, true)?);
        }
        Ok(edges)
    }

    fn add_vertex(&self, author: &mut Ap242Author, p: u32) -> Authored<m::VertexPointId> {
        let point = m::PointRef::CartesianPoint(add_point(author, self.points[p as usize])?);
        author.add_vertex_point("", point)
    }

    /// Per curve true if it is a side of a face: curves inside faces on planes are none.
    fn are_sides(&self, flat: &[FlatFace]) -> Vec<bool> {
        let mut is_side = vec![false; self.curves.len()];
        let mut is_flat = vec![false; self.patches.len()];
        flat.iter().flat_map(|face| &face.patches).for_each(|&p| is_flat[p] = true);
        let curved = (0..self.patches.len()).filter(|&p| !is_flat[p]).flat_map(|p| self.patches[p].sides);
        let all = curved.chain(flat.iter().flat_map(|face| face.loops.iter().flatten().copied()));
        all.for_each(|(curve, _)| is_side[curve] = true);
        is_side
    }

    /// For each patch the number of its colour: the first that no patch before it has across a side, or where all are taken, that of the
    /// fewest.
    fn colours(&self) -> Vec<usize> {
        let mut beside = vec![Vec::new(); self.curves.len()];
        let mut chosen = Vec::with_capacity(self.patches.len());
        for StepPatch { sides, .. } in &self.patches {
            let mut taken = [0; COLOURS.len()];
            for &(curve, _) in sides {
                beside[curve].iter().for_each(|&k: &usize| taken[k] += 1);
            }
            let colour = (0..COLOURS.len()).min_by_key(|&k| taken[k]).unwrap_or(0);
            sides.iter().for_each(|&(curve, _)| beside[curve].push(colour));
            chosen.push(colour);
        }
        chosen
    }
}

/// A face: its surface, and its sides, first those of the outer loop. An inverted one has the normal against that of its patch.
struct FaceOnSurface {
    surface: FaceSurface,
    loops: Vec<Vec<Side>>,
    is_inverted: bool,
}

/// Adds a named face whose sides are some of these edges.
fn add_face(
    author: &mut Ap242Author,
    name: &str,
    face: &FaceOnSurface,
    edges: &BTreeMap<usize, m::EdgeCurveId>,
) -> Authored<m::AdvancedFaceId> {
    // Normals of a cylinder point away from its axis.
    let is_hollow = matches!(face.surface, FaceSurface::Cylinder(_, true));
    let is_along = face.is_inverted == is_hollow;
    let mut bounds = Vec::with_capacity(face.loops.len());
    for sides in &face.loops {
        let mut around = Vec::with_capacity(sides.len());
        for &(curve, reversed) in sides {
            let edge = author.add_oriented_edge("", m::EdgeRef::EdgeCurve(edges[&curve]), !reversed)?;
            around.push(m::OrientedEdgeRef::OrientedEdge(edge));
        }
        let around = m::LoopRef::EdgeLoop(author.add_edge_loop("", around)?);
        // The loop runs counterclockwise around the patch's own normal; the face's flags turn both at once.
        bounds.push(match bounds.is_empty() {
            true => {
                m::FaceBoundRef::FaceOuterBound(author.add_face_outer_bound("", around, !face.is_inverted)?)
            }
            false => m::FaceBoundRef::FaceBound(author.add_face_bound("", around, !face.is_inverted)?),
        });
    }
    let surface = match face.surface {
        FaceSurface::Plane(id) => m::SurfaceRef::Plane(id),
        FaceSurface::Cylinder(id, _) => m::SurfaceRef::CylindricalSurface(id),
        FaceSurface::Spline(id) => m::SurfaceRef::BSplineSurfaceWithKnots(id),
    };
    author.add_advanced_face(name, bounds, surface, is_along)
}
