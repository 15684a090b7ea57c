//! STEP files of splines over four-sided patches.

use super::quad::{fitted_drum, fitted_ellipsoid};
use ricci::spline::{PatchLayout, StepOptions};

#[test]
fn a_step_file_has_a_face_for_each_patch_of_a_closed_shell() {
    let fit = fitted_ellipsoid(6, 1, 0);
    let options = StepOptions { name: "ellipsoid".into(), ..Default::default() };
    let write = |options: &StepOptions| {
        let mut bytes = Vec::new();
        fit.spline.write_step(options, &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    };
    let text = write(&options);
    for (entity, count) in [
        ("ADVANCED_FACE(", 14),
        ("B_SPLINE_SURFACE_WITH_KNOTS(", 14),
        ("EDGE_CURVE(", 28),
        (" SURFACE_CURVE(", 28),
        (" PCURVE(", 56),
        ("STYLED_ITEM(", 0),
        ("'patch 0'", 1),
        ("'patch 13'", 1),
        ("'crease'", 0),
        ("VERTEX_POINT(", 16),
        ("CLOSED_SHELL(", 1),
        ("MANIFOLD_SOLID_BREP(", 1),
    ] {
        assert_eq!(text.matches(entity).count(), count, "{entity}");
    }
    assert_eq!(text, write(&options));
    let coloured = write(&StepOptions { colours: true, ..options });
    assert_eq!(coloured.matches(" STYLED_ITEM(").count(), 14);
    neighbours_differ(&coloured, fit.spline.space().layout());
}

#[test]
fn a_drum_has_planes_and_cylinders() {
    let (fit, lids) = fitted_drum();
    let mut bytes = Vec::new();
    fit.spline.write_step(&StepOptions::default(), &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let barrel = lids.iter().filter(|lid| !**lid).count();
    for (entity, count) in [
        ("ADVANCED_FACE(", 2 + barrel),
        ("= PLANE(", 2),
        ("CYLINDRICAL_SURFACE(", barrel),
        ("B_SPLINE_SURFACE_WITH_KNOTS(", 0),
        ("MANIFOLD_SOLID_BREP(", 1),
        ("'crease'", 2 * barrel),
    ] {
        assert_eq!(text.matches(entity).count(), count, "{entity}");
    }
    assert_eq!(fit.spline.n_step_faces().unwrap(), 2 + barrel);
    // Radii as they are written.
    let radii = text.lines().filter(|line| line.contains("CYLINDRICAL_SURFACE(")).map(|line| {
        let (_, last) = line.trim_end_matches([')', ';']).rsplit_once(',').unwrap();
        last.trim().parse::<f64>().unwrap()
    });
    assert!(radii.map(|radius| (radius - 1.0).abs()).fold(0.0, f64::max) < 1e-5);
}

/// The faces on both sides of every arc have different colours in a STEP file.
fn neighbours_differ(text: &str, layout: &PatchLayout) {
    let entity =
        |number: &str| text.split(&format!("\n#{number} = ")).nth(1).unwrap().split(';').next().unwrap();
    let refers = |number: &str| {
        entity(number).split('#').skip(1).map(|x| x.split([',', ')']).next().unwrap()).collect::<Vec<_>>()
    };
    let colour = |patch: usize| {
        let named = format!(" = ADVANCED_FACE('patch {patch}',");
        let face = text.split(&named).next().unwrap().rsplit('#').next().unwrap();
        let styled = text
            .lines()
            .find(|line| line.contains(" STYLED_ITEM(") && line.contains(&format!("#{face})")))
            .unwrap();
        let mut at = styled.split(['(', '#', ',', ')']).find(|x| x.parse::<u32>().is_ok()).unwrap();
        while !entity(at).starts_with("COLOUR_RGB") {
            at = refers(at)[0];
        }
        entity(at)
    };
    for arc in 0..layout.arcs().len() {
        if let [Some(left), Some(right)] = layout.beside(arc) {
            assert_ne!(colour(left.patch), colour(right.patch), "arc {arc}");
        }
    }
}
