//! The calls of the library that the golden vectors name, one for each kind of case.

use crate::cases::{Case, Found, indices, points};
use crate::common::hex;
use ricci::canonical::{
    Boundary, BoundaryCorner, CircleDomainOptions, Corners, Normalisation, Quotient, QuotientOptions,
    Uniformization, circle_domain, uniformize,
};
use ricci::embed::cover::elements_within;
use ricci::embed::{Layout, LayoutOptions, dirichlet_domain};
use ricci::flow::{Flips, Options, flow};
use ricci::geometry::Space;
use ricci::harmonic::{
    Domain, FormsOptions, HarmonicForms, MapConstraints, PeriodMatrix, harmonic_map, planar,
};
use ricci::matching::{self, MatchOptions, match_surfaces};
use ricci::mesh::{FaceId, Mesh, PerVertex, Point, VertexId};
use ricci::metric::{curvature, initial_metric};
use ricci::spline::{
    self, FitOptions, FlatMetric, KnotOptions, Parameter, Spline, SplineSpace, SurfaceFitOptions, basis_size,
    fit, fit_surface,
};
use ricci::structure::{AtlasOptions, Structure, atlas};
use ricci::{Class, Control, Solution, Surface, Target};
use std::f64::consts::TAU;
use std::sync::Arc;

/// The numbers of a case, with so many threads; `None` for a call that is not one of these.
pub fn call(case: &Case, threads: usize) -> Option<Found> {
    Some(match case.call() {
        "metric" => metric(case),
        "flow" => flowed(case, threads),
        "layout" => layout(case, threads),
        "uniformize" => uniform(case, threads),
        "group" => group(case, threads),
        "circles" => circles(case, threads),
        "harmonic" => harmonic(case),
        "forms" => forms(case),
        "structure" => structure(case, threads),
        "spline" => spline_values(case),
        "fit" => fitted(case, threads),
        "surface_fit" => surface_fit(case, threads),
        "match" => matched(case, threads),
        _ => return None,
    })
}

fn options(case: &Case, threads: usize) -> Options {
    let flips = if case.option("flips").as_str() == Some("never") { Flips::Never } else { Flips::Auto };
    Options { flips, threads, ..Options::default() }
}

fn of_faces(mesh: &Mesh, lengths: &[f64]) -> Vec<f64> {
    mesh.faces().flat_map(|f| mesh.face_edges(f)).map(|e| lengths[e.unsigned_abs() as usize - 1]).collect()
}

fn metric(case: &Case) -> Found {
    let surface = case.surface("mesh");
    let (mesh, geometry) = (surface.mesh(), surface.geometry());
    let class = Class::new(case.scheme(), geometry);
    let start = initial_metric(mesh, surface.lengths(), geometry, class).unwrap().metric;
    let k = curvature(mesh, geometry, &start.lengths(mesh).unwrap()).unwrap();
    vec![("eta", start.rounded_eta().to_vec()), ("curvature", k.at.to_vec())]
}

/// The metric that the options describe: that of the mesh, or a flow's.
fn solved(case: &Case, threads: usize) -> Solution {
    let (surface, class) = (case.surface("mesh"), case.class());
    if case.option("without_flow").is_u64() {
        return Solution::initial_of(surface, class).unwrap();
    }
    let target = if case.option("cones").is_array() {
        let vertices = case.indices("cones").into_iter().map(VertexId);
        Target::Cones(vertices.zip(case.numbers("curvatures")).collect())
    } else {
        Target::All(PerVertex::from(case.numbers("target")))
    };
    let solution = flow(surface, class, &target, &options(case, threads), &Control::new()).unwrap();
    assert!(solution.converged(), "{}", case.name);
    solution
}

fn flowed(case: &Case, threads: usize) -> Found {
    let solution = solved(case, threads);
    let (mesh, flat) = (solution.mesh(), solution.metric());
    let sides = of_faces(mesh, &flat.lengths(mesh).unwrap());
    let mut found = metric(case);
    found.extend([("u", flat.u.to_vec()), ("sides", sides)]);
    found
}

/// The model in which the coordinates of a layout or a chart have distances.
#[derive(Clone, Copy)]
enum Model {
    Plane,
    Poincare,
    UnderSphere,
    Klein,
}

fn distance(model: Model, p: [f64; 2], q: [f64; 2]) -> f64 {
    let apart = (p[0] - q[0]).hypot(p[1] - q[1]);
    let (cross, [a, b]) = (p[0] * q[1] - p[1] * q[0], [p, q].map(|z| z[0] * z[0] + z[1] * z[1]));
    match model {
        Model::Plane => apart,
        Model::Poincare => 2.0 * (apart / ((1.0 - a) * (1.0 - b)).sqrt()).asinh(),
        Model::Klein => ((apart * apart - cross * cross) / ((1.0 - a) * (1.0 - b))).sqrt().asinh(),
        Model::UnderSphere => 2.0 * (apart / ((1.0 + a) * (1.0 + b)).sqrt()).min(1.0).asin(),
    }
}

fn sides(model: Model, at: [[f64; 2]; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| distance(model, at[(k + 1) % 3], at[(k + 2) % 3]))
}

fn layout(case: &Case, threads: usize) -> Found {
    let solution = solved(case, threads);
    let layout = Layout::of_solution(
        &solution,
        &LayoutOptions { threads, ..LayoutOptions::default() },
        &Control::new(),
    )
    .unwrap();
    let model = match layout.space {
        Space::E2 => Model::Plane,
        Space::H2 => Model::Poincare,
        Space::S2 => Model::UnderSphere,
    };
    let faces = layout.corner_uv().unwrap();
    let distances = faces.iter().flatten().map(|z| distance(model, faces[0][0], *z)).collect();
    vec![("sides", faces.iter().flat_map(|f| sides(model, *f)).collect()), ("distances", distances)]
}

fn uniformization(case: &Case, threads: usize) -> Uniformization {
    let boundary = if case.option("corners").is_array() {
        let corner = |v| BoundaryCorner { vertex: VertexId(v), angle: None };
        Boundary::Straight(Corners::At(case.indices("corners").into_iter().map(corner).collect()))
    } else {
        Boundary::Geodesic
    };
    let base = case.option("base").as_u64().map(|v| VertexId(v as u32));
    let how = QuotientOptions { scheme: case.scheme(), base, boundary, flow: options(case, threads) };
    let found = uniformize(&case.surface("mesh"), &how, &Control::new()).unwrap();
    assert!(found.converged(), "{}", case.name);
    found
}

fn uniform(case: &Case, threads: usize) -> Found {
    match uniformization(case, threads) {
        Uniformization::Quotient(q) => vec![
            ("modulus", q.layout.modulus().map_or(vec![], |m| m.to_vec())),
            ("area", vec![q.layout.area]),
            ("extremal_distance", q.extremal_distance().into_iter().collect()),
        ],
        Uniformization::Sphere(s) => {
            vec![("cross_ratios", cross_ratios(&s.positions, &indices(&case.json["mesh"]["faces"])))]
        }
        Uniformization::FlowedSphere(_) => vec![],
    }
}

/// Per corner of every face the cross-ratio of the edge opposite: `|il| |jk| / (|lj| |ki|)` for the edge i j, the corner k and the corner l
/// of the face across.
fn cross_ratios(points: &PerVertex<Point>, faces: &[u32]) -> Vec<f64> {
    let corners = || {
        faces.as_chunks::<3>().0.iter().flat_map(|f| [0, 1, 2].map(|k| [k, k + 1, k + 2].map(|k| f[k % 3])))
    };
    let apart = |i: u32, j: u32| {
        let (p, q) = (points[VertexId(i)], points[VertexId(j)]);
        (p[0] - q[0]).hypot(p[1] - q[1]).hypot(p[2] - q[2])
    };
    corners()
        .map(|[k, i, j]| {
            let l = corners().find(|c| c[1] == j && c[2] == i).unwrap()[0];
            apart(i, l) * apart(j, k) / (apart(l, j) * apart(k, i))
        })
        .collect()
}

fn group(case: &Case, threads: usize) -> Found {
    let Uniformization::Quotient(q) = uniformization(case, threads) else { return vec![] };
    let Quotient { layout, deck, .. } = &*q;
    let control = Control::new();
    let d = dirichlet_domain(deck, layout.corner(deck.corner), layout.area, &control).unwrap();
    let near = elements_within(deck, &d, hex(case.text("radius")), 100_000, &control).unwrap();
    let mut traces: Vec<f64> = near.iter().map(|g| 2.0 * f64::from(g.motion.half_trace()).abs()).collect();
    traces.sort_by(f64::total_cmp);
    vec![("traces", traces)]
}

fn circles(case: &Case, threads: usize) -> Found {
    let mut how = CircleDomainOptions::default();
    how.flow.threads = threads;
    if case.option("three").is_array() {
        let three: [u32; 3] = case.indices("three").try_into().unwrap();
        how.normalisation = Normalisation::Three(three.map(VertexId), [0.0, TAU / 3.0, 2.0 * TAU / 3.0]);
    }
    let domain = circle_domain(&case.surface("mesh"), &how, &Control::new()).unwrap();
    assert!(domain.report.converged);
    let mut by_radius: Vec<[f64; 3]> =
        domain.circles.iter().map(|c| [c.centre[0], c.centre[1], c.radius]).collect();
    by_radius.sort_by(|a, b| b[2].total_cmp(&a[2]));
    let circles = by_radius.into_iter().flatten().collect();
    vec![("modulus", domain.modulus.into_iter().collect()), ("circles", circles)]
}

fn harmonic(case: &Case) -> Found {
    let (surface, control) = (case.surface("mesh"), Control::new());
    let domain = Domain::new(&surface, &control).unwrap();
    if case.text("to") == "disk" {
        let map = planar::to_disk(&domain, &control).unwrap();
        return vec![("radii", map.points.iter().map(|p| p[0].hypot(p[1])).collect())];
    }
    let vertices = case.indices("vertices").into_iter().map(VertexId);
    let values: Vec<(VertexId, Point)> = vertices.zip(points(case.option("values"))).collect();
    let map = harmonic_map(&domain, &MapConstraints { values, flux: None }, &control).unwrap();
    vec![("points", map.points.into_iter().flatten().collect())]
}

fn forms(case: &Case) -> Found {
    let control = Control::new();
    let domain = Domain::new(&case.surface("mesh"), &control).unwrap();
    let forms = HarmonicForms::new(&domain, &FormsOptions::default(), &control).unwrap();
    if !domain.mesh().is_closed() {
        let mut values: Vec<f64> = forms.forms[0].0.iter().map(|x| x.abs()).collect();
        values.sort_by(f64::total_cmp);
        return vec![("absolute", values)];
    }
    vec![("modulus", PeriodMatrix::new(&forms).unwrap().modulus().unwrap().to_vec())]
}

fn structure(case: &Case, threads: usize) -> Found {
    let structure = Structure::ALL.into_iter().find(|s| s.name() == case.text("kind")).unwrap();
    let model = match structure {
        Structure::Conformal | Structure::Affine | Structure::Integer => Model::Plane,
        Structure::Spherical => Model::UnderSphere,
        Structure::Hyperbolic => Model::Poincare,
        Structure::Projective => Model::Klein,
    };
    let how = AtlasOptions { structure, flow: options(case, threads), ..AtlasOptions::default() };
    let atlas = atlas(&case.surface("mesh"), &how, &Control::new()).unwrap();
    let n = case.json["mesh"]["faces"].as_array().unwrap().len() / 3;
    let (mut shown, mut worst) = (vec![[f64::NAN; 3]; n], 0.0f64);
    for chart in &atlas.charts {
        for (f, corners) in chart.faces.iter().zip(&chart.corners) {
            if shown[f.index()][0].is_nan() {
                shown[f.index()] = sides(model, corners.map(|c| chart.coordinates[c as usize]));
            }
        }
    }
    for f in 0..n {
        let places = atlas.places(FaceId(f as u32), [0.5, 0.25, 0.25]).unwrap();
        for other in &places[1..] {
            let moved = atlas.carry(places[0].lift, other.lift, places[0].coordinates).unwrap();
            worst = (0..2).fold(worst, |m, k| m.max((moved[k] - other.coordinates[k]).abs()));
        }
    }
    vec![("sides", shown.into_iter().flatten().collect()), ("carried", vec![worst])]
}

/// The domain of a spline, in the plane.
fn domain(case: &Case) -> spline::PlaneDomain {
    let given = &case.json["mesh"];
    let vertices = points(&given["positions"]).into_iter().map(|[x, y, _]| [x, y]).collect();
    spline::PlaneDomain { vertices, triangles: indices(&given["faces"]).as_chunks().0.to_vec() }
}

fn degree(case: &Case) -> usize {
    case.option("degree").as_u64().unwrap() as usize
}

fn spline_values(case: &Case) -> Found {
    let (domain, degree) = (domain(case), degree(case));
    let pairs: Vec<[f64; 2]> = case.numbers("knots").as_chunks().0.to_vec();
    let knots: Vec<Vec<[f64; 2]>> = pairs.chunks_exact(degree + 1).map(<[_]>::to_vec).collect();
    let space = SplineSpace::planar(&domain, &knots).unwrap();
    let mut control = vec![None; space.n_control_points()];
    let given = points(case.option("control"));
    for (patch, given) in space.patches().iter().zip(given.chunks_exact(basis_size(degree))) {
        for (&at, &point) in patch.control.iter().zip(given) {
            // Where the polar arguments are equal, so are the points of the file.
            assert!(control[at as usize].replace(point).is_none_or(|other| other == point));
        }
    }
    let spline = Spline::new(Arc::new(space), control.into_iter().map(Option::unwrap).collect()).unwrap();
    let mut parts = [vec![], vec![], vec![]];
    for (patch, [x, y]) in case.indices("patches").into_iter().zip(case.numbers("places").as_chunks().0) {
        let at = spline.surface_point(Parameter { patch, x: *x, y: *y }).unwrap();
        parts[0].extend(at.point);
        parts[1].extend(at.first.into_iter().flatten());
        parts[2].extend(at.second.into_iter().flatten());
    }
    ["point", "first", "second"].into_iter().zip(parts).collect()
}

fn fitted(case: &Case, threads: usize) -> Found {
    let domain = domain(case);
    let knots = domain.knots(degree(case), &KnotOptions::default()).unwrap();
    let space = Arc::new(SplineSpace::planar(&domain, &knots).unwrap());
    let locator = spline::Locator::new(&domain);
    let places = |key: &str| -> Vec<Parameter> {
        case.numbers(key).as_chunks().0.iter().map(|at| locator.locate(*at).unwrap()).collect()
    };
    let how = FitOptions { fairness: 0.0, threads };
    let given = points(case.option("points"));
    let found = fit(&space, &places("parameters"), &given, &how, &Control::new()).unwrap().spline;
    let at = |at| found.surface_point(at).unwrap().point;
    vec![("point", places("places").into_iter().flat_map(at).collect())]
}

fn surface_fit(case: &Case, threads: usize) -> Found {
    let (surface, control) = (case.surface("mesh"), Control::new());
    let size = |key: &str| hex(case.json["mesh"][key].as_str().unwrap());
    let (big, small) = (size("a"), size("b"));
    let class = Class::yamabe(Space::E2);
    let flat = flow(surface.clone(), class, &Target::Uniform, &options(case, threads), &control).unwrap();
    let how = SurfaceFitOptions {
        degree: degree(case),
        control_points: case.option("control_points").as_u64().map(|n| n as usize),
        threads,
        ..SurfaceFitOptions::default()
    };
    let spline =
        fit_surface(&surface, &FlatMetric::of(&flat, &control).unwrap(), &how, &control).unwrap().spline;
    let fine = spline.tessellate(3, threads, &control).unwrap();
    let off = |p: &Point| ((p[0].hypot(p[1]) - big).hypot(p[2]) - small).abs();
    vec![("distance", vec![fine.positions.iter().map(off).fold(0.0, f64::max)])]
}

fn matched(case: &Case, threads: usize) -> Found {
    let [source, target]: [Surface; 2] = ["mesh", "target"].map(|key| case.surface(key));
    let arc_length = case.option("boundary").as_str() == Some("arc_length");
    let how = MatchOptions {
        landmarks: case.indices("landmarks").as_chunks().0.iter().map(|pair| pair.map(VertexId)).collect(),
        boundary: if arc_length {
            matching::BoundaryMatching::ArcLength
        } else {
            matching::BoundaryMatching::Slides
        },
        flow: Options { threads, ..Options::default() },
        ..MatchOptions::default()
    };
    let found = match_surfaces(&source, &target, &how, &Control::new()).unwrap();
    let images = found.forward.carry(target.mesh(), target.positions().unwrap()).unwrap();
    vec![("images", images.into_iter().flatten().collect())]
}

/// Formulas below the C face.
pub fn formula(case: &Case) -> Option<Found> {
    use ricci::geometry::conformal::{Vertex, differences, edge};
    use ricci::geometry::triangle::{self, angles_from};
    use ricci::geometry::weights::weights;
    let three = |key: &str| -> [f64; 3] { case.numbers(key).try_into().unwrap() };
    Some(match case.call() {
        "triangle" => {
            let lengths = three("lengths");
            let ours = triangle::angles(case.space(), lengths);
            assert!(!ours.broken(), "{}", case.name);
            vec![("angles", ours.at.to_vec()), ("area", vec![triangle::area(case.space(), lengths)])]
        }
        "circle_pattern" => {
            let (space, eta) = (case.space(), three("eta"));
            let corners = three("u").map(|u| Vertex::new(space, 1, u));
            let edges =
                [0, 1, 2].map(|k| edge(space, corners[(k + 1) % 3], corners[(k + 2) % 3], eta[k]).unwrap());
            let r = differences(corners, edges);
            let weights = weights(space, r, edges.map(|e| e.q2), corners, eta);
            vec![("angles", angles_from(space, r).at.to_vec()), ("weights", weights.to_vec())]
        }
        "derivative" => {
            let surface = case.surface("mesh");
            let (mesh, geometry, n) = (surface.mesh(), surface.geometry(), surface.mesh().n_vertices());
            let class = Class::new(case.scheme(), geometry);
            let start = initial_metric(mesh, surface.lengths(), geometry, class).unwrap().metric;
            let mut derivative = vec![0.0; n * n];
            for (i, j, x) in ricci::flow::curvature_derivative(mesh, &start).unwrap() {
                derivative[i.index() * n + j.index()] = x;
                derivative[j.index() * n + i.index()] = x;
            }
            vec![("derivative", derivative)]
        }
        _ => return None,
    })
}
