//! Trajectories: where they begin, and how far apart they are.

use crate::harmonic::samples::{forms_of, in_space, intrinsic};
use ricci::Control;
use ricci::geometry::Space;
use ricci::harmonic::{HarmonicForms, TrajectoryOptions, indices, integrate, trajectories, with_conjugate};
use ricci::mesh::shapes;
use ricci::topology::cut_graph;

fn drawn(forms: &HarmonicForms, coefficients: &[f64]) -> ricci::harmonic::FormLayout {
    let domain = &forms.domain;
    let form = with_conjugate(forms, forms, coefficients).unwrap();
    let cut = cut_graph(domain.mesh(), domain.lengths(), &[], &Control::new()).unwrap();
    integrate(domain, &form, &cut).unwrap()
}

#[test]
fn lines_on_a_flat_torus_fill_it_evenly() {
    let forms = forms_of(&intrinsic(&shapes::flat_torus([0.0, 1.0], 12, 12).unwrap(), Space::E2));
    let layout = drawn(&forms, &[1.0, 0.0]);
    let options = TrajectoryOptions { spacing: 0.1, ..TrajectoryOptions::default() };
    let lines = trajectories(&layout, forms.domain.face_areas(), &options, &Control::new()).unwrap();
    for spacing in [0.0, 1e-9, f64::NAN, f64::INFINITY] {
        let refused = trajectories(
            &layout,
            forms.domain.face_areas(),
            &TrajectoryOptions { spacing, ..TrajectoryOptions::default() },
            &Control::new(),
        );
        assert!(refused.unwrap_err().to_string().contains("spacing of trajectories"));
    }
    // Closed lines of the torus one after the other: neighbours are between one and two spacings apart.
    assert!((5..=10).contains(&lines.len()), "{}", lines.len());
    let level = |(h, share): (ricci::mesh::HalfedgeId, f64)| {
        let [a, b] = [layout.point(h), layout.point(layout.mesh().next(h))];
        a[1] + share * (b[1] - a[1])
    };
    for line in &lines {
        let first = level(line[0]);
        for &point in line {
            let off = level(point) - first;
            assert!((off - off.round()).abs() < 1e-9, "{off}");
        }
    }
}

#[test]
fn lines_run_into_every_zero() {
    let forms = forms_of(&in_space(&shapes::genus(2, 6).unwrap()));
    let coefficients = [1.0, 0.2, -0.3, 0.5];
    let layout = drawn(&forms, &coefficients);
    let form = with_conjugate(&forms, &forms, &coefficients).unwrap();
    for (vertical, real) in [(false, form.im()), (true, form.re())] {
        let options = TrajectoryOptions { vertical, ..TrajectoryOptions::default() };
        let lines = trajectories(&layout, forms.domain.face_areas(), &options, &Control::new()).unwrap();
        // A vertex of index 1 − s/2 has s of them.
        let prongs: i64 =
            indices(forms.domain.mesh(), &real).vertices.iter().filter(|i| **i < 0).map(|i| 2 - 2 * i).sum();
        let begin = lines.iter().filter(|line| line[0].1 == 0.0).count() as i64;
        assert!(prongs >= 6 && begin == prongs, "{begin} {prongs}");
        assert!(lines.len() as i64 > prongs);
    }
}
