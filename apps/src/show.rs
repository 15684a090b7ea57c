//! The picture of a flow, the surface with its checkerboard beside the layout with its seams; and the picture of a surface alone.

use crate::failure::Failure;
use crate::job::FlowOutcome;
use crate::picture::{
    self, Circle, ColorChoice, FlowPictureArgs, Focus, Picture, ShownLayout, ShownSurface, Style,
    SurfacePictureArgs, Zoom,
};
use crate::quantity;
use crate::surface_layout::SurfaceLayout;
use ricci::embed::CirclePattern;
use ricci::geometry::circle::PowerCircle;
use ricci::mesh::io::Soup;
use ricci::mesh::{FaceId, HalfedgeId, Mesh, PerVertex, Point, VertexId};

/// Least target curvature, radians, of a vertex that gets a dot; a uniform target gives no vertex that much.
const CONE: f64 = 1e-6;
/// Most vertices that get a dot: more of them would hide the surface.
const MOST_CONES: usize = 60;

/// The picture as PNG, or the flat layout alone as SVG where its name ends in `.svg`. Without a layout there is nothing for an SVG to show,
/// and the caller does not ask for one.
pub fn draw(outcome: &FlowOutcome, args: &FlowPictureArgs, threads: usize) -> Result<Vec<u8>, Failure> {
    let input = &outcome.input;
    let laid = outcome.layout.as_ref().ok();
    let drawing = laid.map(|laid| LayoutDrawing::of_flow(outcome, laid));
    let flat = drawing.as_ref().map(LayoutDrawing::flat);
    // Charts are told apart by colours unless something else is asked for.
    let by_charts =
        || laid.filter(|l| l.packed.is_some() && args.color.is_none()).map(|_| ColorChoice::Charts);
    let field = args.color().or_else(by_charts).and_then(|choice| quantity::of_flow(choice, outcome));
    let focus = args.zoom.zip(laid).and_then(|(zoom, laid)| focus(&zoom, laid));
    let style = Style { focus, ..args.style(threads) };
    if let (Some(flat), true) = (&flat, args.base.is_svg()) {
        let drawn = Picture { flat: Some(*flat), field: field.as_ref(), ..Picture::default() };
        return picture::svg(&drawn, &style);
    }
    let (mesh, positions) =
        laid.map_or((input.mesh(), input.positions()), |laid| (laid.mesh(), laid.positions.as_deref()));
    let faces = mesh.triangles();
    let cones = cones(outcome);
    let surface = positions.as_ref().map(|positions| ShownSurface {
        positions,
        faces: &faces,
        corner_uv: drawing.as_ref().map(|p| p.corner_uv.as_slice()),
        seams: drawing.as_ref().map_or(&[], |p| &p.edges),
        cones: &cones,
        is_closed: false,
    });
    picture::png(&Picture { surface, flat, field: field.as_ref(), ..Picture::default() }, &style)
}

/// The surroundings of a vertex on the surface and in its layout; for a metric without positions, in the layout alone.
fn focus(zoom: &Zoom, laid: &SurfaceLayout) -> Option<Focus> {
    let mesh = laid.mesh();
    if let Some(positions) = &laid.positions {
        return surroundings(mesh, positions, zoom, |f| laid.face_uv(f));
    }
    let v = VertexId(zoom.vertex);
    let h = mesh.halfedges().find(|&h| !mesh.is_outside(h) && mesh.origin(h) == v)?;
    let (at_layout, radius) = (laid.corner_uv(h), 0.5 * laid.layout.diameter / zoom.factor);
    Some(Focus { at: [0.0; 3], radius, normal: [0.0; 3], at_layout, radius_layout: radius })
}

/// The surroundings of a vertex, an equal share of the surface and of its drawing in the plane; none where either has no area there.
pub fn surroundings(
    mesh: &Mesh,
    positions: &[Point],
    zoom: &Zoom,
    drawn: impl Fn(FaceId) -> [[f64; 2]; 3],
) -> Option<Focus> {
    let v = VertexId(zoom.vertex);
    let extent = |k: usize| {
        let x = positions.iter().map(|p| p[k]);
        x.clone().fold(f64::NEG_INFINITY, f64::max) - x.fold(f64::INFINITY, f64::min)
    };
    let radius = 0.5 * extent(0).max(extent(1)).max(extent(2)) / zoom.factor;
    let (mut normal, mut area, mut area_layout, mut at_layout) = ([0.0; 3], 0.0, 0.0, None);
    for f in mesh.faces().filter(|&f| mesh.face_vertices(f).contains(&v)) {
        let (corners, uv) = (mesh.face_vertices(f), drawn(f));
        let n = picture::normal(corners.map(|v| positions[v.index()]));
        normal = [0, 1, 2].map(|k| normal[k] + n[k]);
        area += n.iter().map(|x| x * x).sum::<f64>().sqrt();
        area_layout += picture::doubled_area(uv).abs();
        at_layout = at_layout.or(corners.iter().position(|w| *w == v).map(|k| uv[k]));
    }
    let radius_layout = radius * (area_layout / area).sqrt();
    let finite = radius_layout.is_finite() && radius_layout > 0.0 && radius > 0.0;
    let focus = |at_layout| Focus { at: positions[v.index()], radius, normal, at_layout, radius_layout };
    at_layout.filter(|_| finite).map(focus)
}

/// A PNG of a surface without a layout; faces that name no or a non-finite vertex are left out.
pub fn draw_surface(soup: &Soup, args: &SurfacePictureArgs, threads: usize) -> Result<Vec<u8>, Failure> {
    let Soup { positions, faces, .. } = soup;
    let finite = |v: &u32| positions.get(*v as usize).is_some_and(|p| p.iter().all(|x| x.is_finite()));
    let faces: Vec<[u32; 3]> = faces.iter().filter(|f| f.iter().all(finite)).copied().collect();
    // Points that belong to no face would widen the view.
    let mut number = vec![None; positions.len()];
    let mut seen = Vec::new();
    let mut keep = |v: u32| {
        *number[v as usize].get_or_insert_with(|| {
            seen.push(positions[v as usize]);
            seen.len() as u32 - 1
        })
    };
    let faces: Vec<[u32; 3]> = faces.into_iter().map(|f| f.map(&mut keep)).collect();
    let surface = ShownSurface {
        positions: &seen,
        faces: &faces,
        corner_uv: None,
        seams: &[],
        cones: &[],
        is_closed: false,
    };
    let field = args.curvature().then(|| quantity::curvature_of_triangles(&seen, &faces));
    let drawn = Picture { surface: Some(surface), field: field.as_ref(), ..Picture::default() };
    picture::png(&drawn, &args.style(threads))
}

/// Cone vertices with their curvature, on a surface where few vertices have any.
fn cones(outcome: &FlowOutcome) -> Vec<(u32, f64)> {
    let mesh = outcome.input.mesh();
    let curved = |v: &VertexId| !mesh.is_boundary_vertex(*v) && outcome.target(*v).abs() > CONE;
    let cones: Vec<_> = mesh.vertices().filter(curved).map(|v| (v.0, outcome.target(v))).collect();
    if cones.len() <= MOST_CONES { cones } else { Vec::new() }
}

/// A layout as the plain arrays that are drawn.
#[derive(Default)]
pub struct LayoutDrawing {
    pub corner_uv: Vec<[[f64; 2]; 3]>,
    /// The edges of the cut on the surface, with the numbers of their seams.
    pub edges: Vec<(u32, u32, usize)>,
    seams: Vec<([f64; 2], [f64; 2], usize)>,
    boundary: Vec<([f64; 2], [f64; 2])>,
    frame: Vec<([f64; 2], [f64; 2])>,
    cones: Vec<([f64; 2], f64)>,
    circles: Vec<Circle>,
    dual_circles: Vec<Circle>,
}

impl LayoutDrawing {
    /// A layout with dots at its cones, which are given with their curvature.
    pub fn new(laid: &SurfaceLayout, cones: &[(u32, f64)]) -> LayoutDrawing {
        let mesh = laid.mesh();
        let side = |h: HalfedgeId| (laid.corner_uv(h), laid.corner_uv(mesh.next(h)));
        let corner_uv = mesh.faces().map(|f| laid.face_uv(f)).collect();
        let mut drawing = LayoutDrawing { corner_uv, ..LayoutDrawing::default() };
        for (h, number) in laid.seams() {
            drawing.edges.push((mesh.origin(h).0, mesh.tip(h).0, number));
            for h in [h, h.twin()] {
                let (a, b) = side(h);
                drawing.seams.push((a, b, number));
            }
        }
        for h in mesh.halfedges().filter(|h| mesh.is_outside(h.twin())) {
            drawing.boundary.push(side(h));
        }
        if laid.packed.is_some() {
            let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
            drawing.frame = (0..4).map(|k| (square[k], square[(k + 1) % 4])).collect();
        }
        let mut seen = vec![false; laid.coordinates().len()];
        let mut curvature = PerVertex::filled(mesh.n_vertices(), 0.0);
        cones.iter().for_each(|&(v, k)| curvature[VertexId(v)] = k);
        for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h) && curvature[mesh.origin(h)] != 0.0) {
            let uv = laid.corner_index()[h] as usize;
            if !std::mem::replace(&mut seen[uv], true) {
                drawing.cones.push((laid.coordinates()[uv], curvature[mesh.origin(h)]));
            }
        }
        drawing
    }

    /// The layout of a flow, with its circles.
    fn of_flow(outcome: &FlowOutcome, laid: &SurfaceLayout) -> LayoutDrawing {
        let mut drawing = LayoutDrawing::new(laid, &cones(outcome));
        // Circles belong to the whole layout, and do not fit its charts.
        let with_circles = outcome.solved.scheme.epsilon() != 0 && laid.packed.is_none();
        let pattern = || {
            let solution = &outcome.solved.solution;
            CirclePattern::new(&laid.layout, solution.mesh(), solution.metric()).ok()
        };
        if let Some(pattern) = with_circles.then(pattern).flatten() {
            let vertex = pattern.vertex_circles.iter().map(|c| Circle { centre: c.centre, radius: c.radius });
            drawing.circles = vertex.collect();
            let dual = pattern.dual_circles.iter().filter(|(_, c)| c.power >= 0.0);
            let circle = |c: &PowerCircle| Circle { centre: c.centre, radius: c.power.sqrt() };
            drawing.dual_circles = dual.map(|(_, c)| circle(c)).collect();
        }
        drawing
    }

    pub fn flat(&self) -> ShownLayout<'_> {
        ShownLayout {
            corner_uv: &self.corner_uv,
            seams: &self.seams,
            boundary: &self.boundary,
            frame: &self.frame,
            cones: &self.cones,
            circles: &self.circles,
            dual_circles: &self.dual_circles,
            ..ShownLayout::default()
        }
    }
}
