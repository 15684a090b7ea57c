//! Quantities that pictures show in colours.

use crate::input::Input;
use crate::job::FlowOutcome;
use crate::picture::{CLASSES, ColorChoice, ColorField, ColorScale, HUES};
use crate::surface_layout::SurfaceLayout;
use ricci::geometry::triangle;
use ricci::geometry::vector::{cross, dot, norm, sub, triangle_normal};
use ricci::mesh::{FaceId, Mesh, PerFace, PerVertex, Point};
use ricci::metric::CommonSubdivision;
use ricci::metric::curvature::{curvature, curvature_from_angles};

/// The quantity of a finished flow; `None` for no quantity, and for one of the layout where the flow has no layout.
pub fn of_flow(choice: ColorChoice, outcome: &FlowOutcome) -> Option<ColorField> {
    let (input, laid) = (&outcome.input, outcome.layout.as_ref().ok());
    let mesh = laid.map_or(input.mesh(), |laid| laid.mesh());
    Some(match choice {
        ColorChoice::None => return None,
        ColorChoice::U => {
            let factor = outcome.solved.solution.conformal_factor().ok()?;
            let scale = ColorScale::of_signed("log conformal factor u", &factor);
            at_vertices(mesh, &on_layout(&factor, laid)?, scale)
        }
        ColorChoice::Curvature => {
            let (density, scale) = density_of_input(input)?;
            at_vertices(mesh, &on_layout(&density, laid)?, scale)
        }
        ColorChoice::Qc => {
            let values: Vec<f64> = laid?.quality.qc.to_vec();
            let scale = ColorScale::of_amounts("quasi-conformal dilatation K", &values);
            at_faces(&values, scale)
        }
        ColorChoice::Area => {
            let values: Vec<f64> = laid?.quality.area_ratio.iter().map(|r| r.log2()).collect();
            let scale = ColorScale::of_signed("log2 of area in the layout over area on the surface", &values);
            at_faces(&values, scale)
        }
        ColorChoice::Pieces => pieces(laid?),
        ColorChoice::Charts => charts(laid?)?,
    })
}

/// Pieces in colours: a hue for the face of the final triangulation, a shade for that of the input. Faces side by side differ.
fn pieces(laid: &SurfaceLayout) -> ColorField {
    let mesh = laid.mesh();
    let parts = |of: fn(&CommonSubdivision) -> &PerFace<FaceId>| match laid.common_subdivision() {
        Some(subdivision) => of(subdivision).clone(),
        None => mesh.faces().collect::<Vec<_>>().into(),
    };
    let hue = classes(mesh, &parts(|r| &r.faces[1]));
    let shade = classes(mesh, &parts(|r| &r.faces[0]));
    let values: Vec<f64> = hue.iter().zip(shade).map(|(hue, shade)| (CLASSES * hue + shade) as f64).collect();
    let title = "hue by face of the final triangulation, shade by face of the input";
    at_faces(&values, ColorScale::of_pairs(title, "what a face of each has in common is a piece"))
}

/// Charts in colours that differ from those of their neighbours on the surface.
fn charts(laid: &SurfaceLayout) -> Option<ColorField> {
    let charts = &laid.packed.as_ref()?.charts;
    let color = hues(laid.mesh(), |f| Some(charts.chart[f]), charts.count());
    let values: Vec<f64> = charts.chart.iter().map(|&chart| color[chart as usize] as f64).collect();
    let title = "charts: neighbours have different colours";
    Some(at_faces(&values, ColorScale::of_hues(title, "charts that are no neighbours share colours")))
}

/// A colour for each of `n` charts, in their order: one that no neighbour has, as long as there is one; else that of the fewest edges. Faces
/// may have no chart.
pub fn hues(mesh: &Mesh, chart: impl Fn(FaceId) -> Option<u32>, n: usize) -> Vec<usize> {
    let mut neighbours = vec![Vec::new(); n];
    for h in mesh.edges().map(|e| e.halfedge()) {
        if let [Some(a), Some(b)] = [h, h.twin()].map(|h| mesh.face(h).and_then(&chart))
            && a != b
        {
            neighbours[a as usize].push(b as usize);
            neighbours[b as usize].push(a as usize);
        }
    }
    let mut color = vec![HUES; n];
    for c in 0..n {
        let edges = |hue: &usize| neighbours[c].iter().filter(|&&other| color[other] == *hue).count();
        // Charts with successive numbers begin with different colours, so that few charts do not all have the first ones.
        let order = (0..HUES).map(|k| (c + k) % HUES);
        color[c] = order.min_by_key(edges).unwrap_or(0);
    }
    color
}

/// Per face of the mesh a class of the larger triangle (`whole`) that it is part of: two of these that share an edge have different
/// classes. A triangle has at most three neighbours, so that the first class which none of them has is one of four.
fn classes(mesh: &Mesh, whole: &PerFace<FaceId>) -> Vec<usize> {
    let n = whole.iter().map(|f| f.index() + 1).fold(0, usize::max);
    let mut neighbours = vec![Vec::new(); n];
    for h in mesh.edges().map(|e| e.halfedge()) {
        if let (Some(f), Some(g)) = (mesh.face(h), mesh.face(h.twin()))
            && whole[f] != whole[g]
        {
            neighbours[whole[f].index()].push(whole[g].index());
            neighbours[whole[g].index()].push(whole[f].index());
        }
    }
    let mut class = vec![CLASSES; n];
    for f in 0..n {
        let free = |c: &usize| neighbours[f].iter().all(|&g| class[g] != *c);
        class[f] = (0..CLASSES).find(free).unwrap_or(0);
    }
    whole.iter().map(|f| class[f.index()]).collect()
}

const CURVATURE: &str = "Gaussian curvature K (1/length²)";

/// Values at given vertices, at those of what is laid out.
fn on_layout(given: &[f64], laid: Option<&SurfaceLayout>) -> Option<PerVertex<f64>> {
    let Some(subdivision) = laid.and_then(|laid| laid.common_subdivision()) else {
        return Some(given.to_vec().into());
    };
    let given: Vec<[f64; 1]> = given.iter().map(|x| [*x]).collect();
    let all = subdivision.from_vertices(0, &given).ok()?;
    Some(all.into_iter().map(|[x]| x).collect::<Vec<_>>().into())
}

/// Gaussian curvature of a surface: the angle defect of each vertex over a third of the area around it.
fn density_of_input(input: &Input) -> Option<(PerVertex<f64>, ColorScale)> {
    let surface = &input.surface;
    let (mesh, lengths, geometry) = (surface.mesh(), surface.lengths(), surface.geometry());
    let defect = curvature(mesh, geometry, lengths).ok()?.at;
    let area = |f: FaceId| triangle::area(geometry, mesh.opposite_edges(f).map(|e| lengths[e]));
    Some(density(mesh, &defect, area, geometry.curvature()))
}

/// The curvature of any triangle list; none at vertices where it is no surface.
pub fn curvature_of_triangles(points: &[Point], faces: &[[u32; 3]]) -> ColorField {
    let corners = |f: FaceId| faces[f.index()].map(|v| points[v as usize]);
    if let Ok(mesh) = Mesh::from_faces(points.len(), faces) {
        let angles = mesh.faces().map(|f| angles(corners(f)));
        let defect = curvature_from_angles(&mesh, angles);
        let (values, scale) = density(&mesh, &defect, |f| area(corners(f)), 0.0);
        return at_vertices(&mesh, &values, scale);
    }
    ColorField { corners: vec![[f64::NAN; 3]; faces.len()], scale: ColorScale::of_signed(CURVATURE, &[]) }
}

/// Angle defects over areas, with what the background geometry adds. A vertex of the boundary has the mean of its
/// neighbours inside.
fn density(
    mesh: &Mesh,
    defect: &PerVertex<f64>,
    area: impl Fn(FaceId) -> f64,
    background: f64,
) -> (PerVertex<f64>, ColorScale) {
    let mut around = PerVertex::filled(mesh.n_vertices(), 0.0);
    for f in mesh.faces() {
        let third = area(f) / 3.0;
        mesh.face_vertices(f).into_iter().for_each(|v| around[v] += third);
    }
    let inside = |v| !mesh.is_boundary_vertex(v);
    let own = |v| if inside(v) { defect[v] / around[v] + background } else { f64::NAN };
    let mut values = PerVertex::from_fn(mesh.n_vertices(), own);
    let mut sums = PerVertex::filled(mesh.n_vertices(), (0.0, 0.0));
    for h in mesh.halfedges() {
        let (a, b) = (mesh.origin(h), mesh.tip(h));
        if !inside(a) && inside(b) {
            sums[a].0 += values[b];
            sums[a].1 += 1.0;
        }
    }
    let scale = ColorScale::of_signed(CURVATURE, &values);
    mesh.vertices().filter(|v| !inside(*v)).for_each(|v| values[v] = sums[v].0 / sums[v].1);
    (values, scale)
}

/// Values at vertices, linear in each face.
pub fn at_vertices(mesh: &Mesh, values: &PerVertex<f64>, scale: ColorScale) -> ColorField {
    ColorField { corners: mesh.faces().map(|f| mesh.face_vertices(f).map(|v| values[v])).collect(), scale }
}

fn at_faces(values: &[f64], scale: ColorScale) -> ColorField {
    ColorField { corners: values.iter().map(|v| [*v; 3]).collect(), scale }
}

fn angles(p: [Point; 3]) -> [f64; 3] {
    let angle = |k: usize| {
        let [a, b] = [1, 2].map(|i| sub(p[(k + i) % 3], p[k]));
        f64::atan2(norm(cross(a, b)), dot(a, b))
    };
    [0, 1, 2].map(angle)
}

fn area(p: [Point; 3]) -> f64 {
    0.5 * norm(triangle_normal(p))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ricci::mesh::shapes;

    #[test]
    fn spheres_have_the_curvature_of_their_radius() {
        for radius in [1.0, 3.0] {
            let soup = shapes::ellipsoid([radius; 3], 24).unwrap();
            let field = curvature_of_triangles(&soup.positions, &soup.faces);
            let all = field.corners.as_flattened();
            let mean = all.iter().sum::<f64>() / all.len() as f64;
            assert!((mean * radius * radius - 1.0).abs() < 0.01, "{mean} at radius {radius}");
            assert!((field.scale.range[1] * radius * radius - 1.0).abs() < 0.05, "{:?}", field.scale.range);
        }
    }

    #[test]
    fn faces_side_by_side_have_different_classes() {
        let mesh = Mesh::from_soup(&shapes::icosphere(6).unwrap()).unwrap();
        let own: Vec<FaceId> = mesh.faces().collect();
        let class = classes(&mesh, &own.into());
        for h in mesh.halfedges() {
            let [f, g] = [h, h.twin()].map(|h| class[mesh.face(h).unwrap().index()]);
            assert!(f != g && f < CLASSES, "{f} {g}");
        }
        // One whole has one class.
        let one = PerFace::filled(mesh.n_faces(), FaceId(0));
        assert!(classes(&mesh, &one).iter().all(|c| *c == 0));
    }

    #[test]
    fn charts_side_by_side_have_different_colours() {
        let mesh = Mesh::from_soup(&shapes::icosphere(6).unwrap()).unwrap();
        let chart = PerFace::from_fn(mesh.n_faces(), |f| f.0 / 7);
        let color = hues(&mesh, |f| Some(chart[f]), mesh.n_faces());
        for e in mesh.edges() {
            let [a, b] = [e.halfedge(), e.halfedge().twin()].map(|h| chart[mesh.face(h).unwrap()] as usize);
            assert!(a == b || color[a] != color[b], "charts {a} and {b} are both {}", color[a]);
        }
    }

    #[test]
    fn what_is_no_surface_has_no_curvature() {
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
        let book = [[0, 1, 2], [0, 1, 3], [0, 1, 4]];
        let field = curvature_of_triangles(&points, &book);
        assert!(field.corners.len() == 3 && field.corners.as_flattened().iter().all(|x| x.is_nan()));
    }
}
