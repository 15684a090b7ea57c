//! Circle domains at the end of what doubles hold: long tubes, whose loops are seen from far away.

use crate::circles::check::{check, domain, domain_of};
use crate::circles::known::strip;
use ricci::canonical::{CircleDomain, CircleDomainOptions, DomainFrame, Normalisation, circle_domain};
use ricci::mesh::VertexId;
use ricci::mesh::io::Soup;
use ricci::{Control, Error, Surface};
use std::f64::consts::TAU;

/// A cylinder of radius 1 and this modulus, its height over its circumference, of n squares around.
fn cylinder(modulus: f64, n: usize) -> Soup {
    let rows = (modulus * n as f64).round() as usize;
    strip(rows, n, |t, angle| [angle.cos(), angle.sin(), TAU * modulus * t])
}

fn laid_out(surface: &Surface, frame: DomainFrame) -> CircleDomain {
    let options = CircleDomainOptions { frame, ..CircleDomainOptions::default() };
    circle_domain(surface, &options, &Control::new()).unwrap()
}

/// The modulus of the polyhedron: squares on a polygon of n sides.
fn polygonal(modulus: f64, n: usize) -> f64 {
    let n = n as f64;
    modulus * TAU / (2.0 * n * (TAU / (2.0 * n)).sin())
}

#[test]
fn long_cylinders_become_round_in_the_disk() {
    for modulus in [3.0, 6.2] {
        let d = domain(&cylinder(modulus, 24));
        check(&d, "long cylinder", 1e-10);
        let exact = polygonal(modulus, 24);
        let inner = d.circles.iter().find(|c| Some(c.boundary_loop) != d.outer).unwrap();
        println!("modulus {modulus}: radius {:e}, off by {:.1e}", inner.radius, d.report.deviation);
        assert!((d.modulus.unwrap() - exact).abs() < 1e-2 * exact);
        assert!((inner.log_radius + TAU * d.modulus.unwrap()).abs() < 1e-9);
        assert_eq!(d.frame, DomainFrame::Disk);
    }
}

#[test]
fn long_sheets_become_disks_although_their_ends_are_points_to_doubles() {
    // Seen from the middle of a sheet n times as long as wide, an end has the size e^(−πn/2): 1e-34 and 1e-68. Triangles that reach there
    // have a side which sums of the others do not show.
    for n in [50, 100] {
        let corners = (0..3 * (2 * n + 1)).map(|v| [0.5 * f64::from(v / 3), 0.5 * f64::from(v % 3), 0.0]);
        let square = |s: u32| {
            let [a, b] = [3 * (s / 2) + s % 2, 3 * (s / 2) + s % 2 + 3];
            [[a, b, b + 1], [a, b + 1, a + 1]]
        };
        let d = domain(&Soup::new(corners.collect(), (0..4 * n).flat_map(square).collect()));
        assert!(d.report.converged, "{n}: {:?}", d.report);
        assert_eq!(d.layout.flipped, []);
        assert!(d.report.deviation < 1e-12 && d.report.domain_curvature_error < 1e-10, "{n}: {:?}", d.report);
        assert!(d.layout.coordinates.iter().all(|&[x, y]| x.hypot(y) < 1.0 + 1e-12));
    }
}

#[test]
fn a_strip_holds_annuli_of_any_modulus() {
    for modulus in [0.5, 6.2, 150.0] {
        let (n, exact) = (12, polygonal(modulus, 12));
        let surface = Surface::from_soup(&cylinder(modulus, n)).unwrap();
        let d = laid_out(&surface, DomainFrame::Strip);
        assert!(d.report.converged, "{modulus}: {:?}", d.report);
        // The cylinder over a polygon unrolls: its modulus is that of the rectangle.
        assert!((d.modulus.unwrap() / exact - 1.0).abs() < 1e-10, "{modulus}: {:?}", d.modulus);
        let inner = d.circles.iter().find(|c| Some(c.boundary_loop) != d.outer).unwrap();
        assert!((inner.log_radius / (-TAU * exact) - 1.0).abs() < 1e-10);
        assert!(inner.radius.is_finite() && d.report.deviation < 1e-10);
        let heights = || d.layout.coordinates.iter().map(|p| p[1]);
        let [low, high] = [heights().fold(f64::MAX, f64::min), heights().fold(f64::MIN, f64::max)];
        assert!(low.abs() < 1e-9 && (high / (TAU * exact) - 1.0).abs() < 1e-10, "{low} {high}");
        let around = d.layout.seams[0].isometry();
        assert!(around.rotation.abs() < 1e-10 && (around.translation[0].abs() - TAU).abs() < 1e-9);
    }
}

#[test]
fn an_annulus_that_the_disk_does_not_hold_lies_in_a_strip() {
    let surface = Surface::from_soup(&cylinder(40.0, 12)).unwrap();
    let d = domain_of(&surface);
    assert!(d.report.converged && d.frame == DomainFrame::Strip, "{:?}", d.report);
}

#[test]
fn the_strip_and_the_disk_are_the_same_annulus() {
    let soup = strip(24, 64, |t, angle| {
        let (r, [x, y]) = (0.3 + 0.7 * t, [angle.cos(), angle.sin()]);
        [r * x + 0.4 * (1.0 - t), r * y, 0.0]
    });
    let surface = Surface::from_soup(&soup).unwrap();
    let [disk, strip] = [DomainFrame::Disk, DomainFrame::Strip].map(|frame| laid_out(&surface, frame));
    let exact = ((1.0 + 0.09 - 0.16) / 0.6f64).acosh() / TAU;
    for d in [&disk, &strip] {
        assert!(d.report.converged && (d.modulus.unwrap() / exact - 1.0).abs() < 2e-3, "{:?}", d.modulus);
    }
    assert_eq!(disk.outer, strip.outer);
}

#[test]
fn a_strip_is_for_annuli_alone() {
    let run = |soup: &Soup, options: CircleDomainOptions| {
        circle_domain(&Surface::from_soup(soup).unwrap(), &options, &Control::new())
    };
    let frame = DomainFrame::Strip;
    let usual = CircleDomainOptions { frame, ..CircleDomainOptions::default() };
    let disk = ricci::mesh::shapes::disk(3).unwrap();
    assert!(matches!(run(&disk, usual.clone()), Err(Error::Argument { .. })));
    let placed = CircleDomainOptions { normalisation: Normalisation::Vertex(VertexId(30)), ..usual };
    assert!(matches!(run(&cylinder(1.0, 12), placed), Err(Error::Argument { .. })));
}

/// A long tube with holes along it: a disk cannot be centred on both ends, but doubles hold the far end where they are dense, at 0.
#[test]
fn a_long_tube_with_holes_becomes_round() {
    let mut soup = cylinder(6.2, 24);
    let hole = |row: usize, column: usize, f: &[u32; 3]| {
        f.iter().all(|&v| {
            let (i, j) = (v as usize / 24, v as usize % 24);
            (row..=row + 3).contains(&i) && (column..=column + 3).contains(&j)
        })
    };
    soup.faces.retain(|f| ![(20, 2), (48, 10), (70, 15), (120, 4)].iter().any(|&(r, c)| hole(r, c, f)));
    // The corners of the vertices that are left belong to no face.
    let surface = Surface::from_soup(&without_loose_vertices(&soup)).unwrap();
    let d = domain_of(&surface);
    println!("{:?} centred on {:?}", d.report.deviation, d.report.centred_on);
    assert!(d.report.converged && d.circles.len() == 6, "{:?} {:?}", d.report, d.circles);
    assert!(d.report.deviation < 1e-10 && d.report.centred_on.is_some());
}

fn without_loose_vertices(soup: &Soup) -> Soup {
    let mut number = vec![u32::MAX; soup.positions.len()];
    let mut kept = Soup::default();
    for f in &soup.faces {
        kept.faces.push(f.map(|v| {
            let known = &mut number[v as usize];
            if *known == u32::MAX {
                *known = kept.positions.len() as u32;
                kept.positions.push(soup.positions[v as usize]);
            }
            *known
        }));
    }
    kept
}

#[test]
fn the_verdict_is_that_of_the_domain() {
    let mut options = CircleDomainOptions { frame: DomainFrame::Disk, ..CircleDomainOptions::default() };
    options.flow.tolerance = 1e-15;
    let surface = Surface::from_soup(&cylinder(3.0, 24)).unwrap();
    let d = circle_domain(&surface, &options, &Control::new()).unwrap();
    // No domain of doubles is flat to 1e-15 at every vertex.
    assert!(!d.report.converged && d.report.domain_curvature_error > 1e-15, "{:?}", d.report);
    assert_ne!(d.report.stop_reason.name(), "converged");
    assert!(d.report.worst_vertex.is_some() && d.report.worst_loop.is_some());
}
