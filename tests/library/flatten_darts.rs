//! Strains of sheets, and darts that keep them within limits.

use ricci::flatten::{
    DartOptions, FlattenOptions, InflateOptions, StrainLimits, cut_open, flat_part, flatten,
    flatten_with_darts, inflate, medial_wall, strains,
};
use ricci::mesh::{PerEdge, VertexId, shapes};
use ricci::{Control, Error, Surface};

fn lifted(rings: usize, height: impl Fn(f64) -> f64) -> Surface {
    let mut soup = shapes::disk(rings).unwrap();
    soup.positions.iter_mut().for_each(|[x, y, z]| *z = height(x.hypot(*y)));
    Surface::from_soup(&soup).unwrap()
}

fn limits(x: f64) -> StrainLimits {
    StrainLimits { warp: x, weft: x, ..StrainLimits::default() }
}

#[test]
fn the_strain_of_an_affine_map_is_known_along_its_threads() {
    let surface = lifted(4, |_| 0.0);
    // The plane is the surface stretched by 2 along x and by 4 along y: sheets are strained by −1/2 and −3/4.
    let points: Vec<[f64; 2]> =
        surface.positions().unwrap().iter().map(|p| [2.0 * p[0], 4.0 * p[1]]).collect();
    let along = |warp: f64| strains(&surface, &points, warp).unwrap();
    for strain in along(0.0) {
        assert!((strain.warp + 0.5).abs() < 1e-12 && (strain.weft + 0.75).abs() < 1e-12);
        assert!(strain.shear.abs() < 1e-12);
    }
    // Threads at 45° come to lie at (1/2, ±1/4)/√2.
    let length = (0.25_f64 + 0.0625).sqrt() / 2.0_f64.sqrt();
    for strain in along(std::f64::consts::FRAC_PI_4) {
        assert!((strain.warp - (length - 1.0)).abs() < 1e-12 && (strain.weft - strain.warp).abs() < 1e-12);
        // The second thread is at (−1/2, 1/4)/√2: the cosine between them is (−1/4 + 1/16)/(1/4 + 1/16).
        assert!((strain.shear - (-0.6_f64).asin()).abs() < 1e-12, "{strain:?}");
    }
    assert!((along(0.3).iter().map(|strain| strain.share).sum::<f64>() - 1.0).abs() < 1e-12);
}

#[test]
fn one_dart_unrolls_a_cone() {
    // Vertices on circles make a cone that is bent a little in its triangles too.
    let cone = lifted(10, |r| 0.8 * r);
    let darts = DartOptions { limits: limits(0.02), ..DartOptions::default() };
    let found = flatten_with_darts(&cone, &FlattenOptions::default(), &darts, &Control::new()).unwrap();
    assert_eq!(found.darts.len(), 1);
    let dart = &found.darts[0];
    assert_eq!((dart.path[0], dart.path.len()), (VertexId(0), 11));
    assert!((dart.length - 1.0_f64.hypot(0.8)).abs() < 1e-12);
    assert!(found.taken[0] > 20.0 && found.taken[1] < 1.0, "{:?}", found.taken);
    assert!(found.flat.report.after.energy - 4.0 < 2e-5);
    assert_eq!(found.origins.len(), cone.mesh().n_vertices() + 10);
    let [a, b] = [found.surface.area().unwrap(), cone.area().unwrap()];
    assert!((a - b).abs() < 1e-12);
}

#[test]
fn darts_stay_within_their_budget_and_lower_the_energy() {
    let dome = lifted(12, |r| 0.9 * (1.0 - r * r));
    let wish = DartOptions { limits: limits(0.05), budget: 4.0, most: 5, ..DartOptions::default() };
    let found = flatten_with_darts(&dome, &FlattenOptions::default(), &wish, &Control::new()).unwrap();
    let without = flatten(&dome, &FlattenOptions::default(), &Control::new()).unwrap().report.after.energy;
    let energies: Vec<f64> =
        std::iter::once(without).chain(found.darts.iter().map(|dart| dart.energy)).collect();
    println!("{energies:?} {:?}", found.taken);
    assert!(!found.darts.is_empty() && energies.windows(2).all(|pair| pair[1] < pair[0]), "{energies:?}");
    assert!(found.darts.iter().map(|dart| dart.length).sum::<f64>() <= 4.0);
    for dart in &found.darts {
        let border = dart.path.last().unwrap();
        assert!(
            dome.mesh().is_boundary_vertex(*border)
                || found.darts.iter().any(|other| other.path.contains(border))
        );
    }
    // A budget that no dart fits in leaves the map as it is.
    let poor = DartOptions { budget: 1e-3, ..wish };
    let none = flatten_with_darts(&dome, &FlattenOptions::default(), &poor, &Control::new()).unwrap();
    assert!(none.darts.is_empty() && none.flat.report.after.energy == without);
}

#[test]
fn cuts_open_surfaces_and_keep_their_faces() {
    let disk = lifted(3, |r| r);
    let (same, origins) = cut_open(&disk, &PerEdge::filled(disk.mesh().n_edges(), false)).unwrap();
    assert!(same.mesh().triangles() == disk.mesh().triangles() && origins.len() == disk.mesh().n_vertices());
    let bare = Surface::intrinsic(disk.mesh().clone(), disk.lengths().clone(), disk.geometry()).unwrap();
    let mut is_cut = PerEdge::filled(disk.mesh().n_edges(), false);
    let mesh = disk.mesh();
    let spoke = mesh.edges().find(|&e| {
        let [a, b] = mesh.ends(e);
        mesh.is_boundary_vertex(a) != mesh.is_boundary_vertex(b)
    });
    is_cut[spoke.unwrap()] = true;
    let (opened, origins) = cut_open(&bare, &is_cut).unwrap();
    assert_eq!(origins.len(), mesh.n_vertices() + 1);
    assert_eq!(opened.mesh().n_edges(), mesh.n_edges() + 1);
    assert!((opened.area().unwrap() - disk.area().unwrap()).abs() < 1e-12);
}

#[test]
fn limits_that_mean_nothing_are_refused() {
    let disk = lifted(3, |_| 0.0);
    let refused = |options: &FlattenOptions, darts: &DartOptions| match flatten_with_darts(
        &disk,
        options,
        darts,
        &Control::new(),
    )
    .unwrap_err()
    {
        Error::Argument { what, .. } => what,
        other => panic!("{other}"),
    };
    let usual = FlattenOptions::default();
    let darts = DartOptions { limits: limits(0.0), ..DartOptions::default() };
    assert_eq!(refused(&usual, &darts), "limit along the warp");
    let darts = DartOptions { budget: -1.0, ..DartOptions::default() };
    assert_eq!(refused(&usual, &darts), "budget");
    let pinned = FlattenOptions { pins: vec![(VertexId(0), [0.0; 2])], ..usual };
    assert_eq!(refused(&pinned, &DartOptions::default()), "pins and straight pieces");
    assert!(strains(&disk, &[[0.0; 2]; 37], 0.0).is_err());
}

#[test]
fn a_folded_ball_is_inflated_to_a_rounder_one_and_its_wall_is_found() {
    let mut soup = shapes::ellipsoid([1.0, 1.5, 1.2], 10).unwrap();
    for p in &mut soup.positions {
        let by = 1.0 + 0.08 * (9.0 * p[0]).sin() * (8.0 * p[1]).cos();
        *p = p.map(|x| by * x);
    }
    let ball = Surface::from_soup(&soup).unwrap();
    let spread = |points: &[[f64; 3]]| {
        let lengths: Vec<f64> = points.iter().map(|p| p.iter().map(|x| x * x).sum::<f64>().sqrt()).collect();
        let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
        (lengths.iter().map(|l| (l - mean).powi(2)).sum::<f64>() / lengths.len() as f64).sqrt() / mean
    };
    let view = |time: f64, threads: usize| {
        inflate(&ball, &InflateOptions { time, threads, ..InflateOptions::default() }, &Control::new())
            .unwrap()
    };
    let views = [0.001, 0.01, 1.0].map(|time| view(time, 2));
    let spreads = views.each_ref().map(|points| spread(points));
    println!("{spreads:?}");
    assert!(spreads[0] > spreads[1] && spreads[1] > spreads[2] && spreads[2] < 0.02, "{spreads:?}");
    assert!(views[1] == view(0.01, 1));
    let swollen = Surface::in_space(ball.mesh().clone(), views[1].clone()).unwrap();
    assert!((swollen.area().unwrap() / ball.area().unwrap() - 1.0).abs() < 1e-12);
    let wall = medial_wall(&ball, &views[1], [-1.0, 0.0, 0.0], 0.1).unwrap();
    let of_wall: Vec<f64> = (0..wall.len()).filter(|&v| wall[v]).map(|v| views[1][v][0]).collect();
    assert!(of_wall.iter().all(|x| *x < 0.0) && of_wall.len() > wall.len() / 30);
    // The rest is a disk.
    let marks: Vec<bool> = wall.iter().map(|wall| !wall).collect();
    assert_eq!(flat_part(&ball, &marks).unwrap(), marks);
    assert!(
        medial_wall(&ball, &views[1], [0.0; 3], 0.1).is_err()
            && medial_wall(&ball, &views[1], [1.0, 0.0, 0.0], 1.0).is_err()
    );
}
