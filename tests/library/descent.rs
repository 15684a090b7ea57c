//! The gradient flow goes down: its energy falls at every step, on every kind of surface and in every space.

use ricci::flow::{Flips, Gradient, Method, Options, Report, StepRule, flow};
use ricci::geometry::Space;
use ricci::mesh::io::Soup;
use ricci::mesh::shapes;
use ricci::metric::Scheme;
use ricci::{Class, Control, Surface, Target};

/// The report of the gradient flow to the default target.
fn descend(soup: &Soup, class: Class, gradient: Gradient, tolerance: f64) -> Report {
    let surface = Surface::from_soup(soup).unwrap();
    let target = Target::default_for(&surface, class.space).unwrap();
    let options =
        Options { method: Method::Gradient, flips: Flips::Never, gradient, tolerance, ..Options::default() };
    let solution = flow(surface, class, &target, &options, &Control::new()).unwrap();
    solution.report().unwrap().clone()
}

/// Checks that the energy falls from each step to the next, or stays where a change is below its rounding.
fn goes_down(report: &Report, name: &str) {
    let trace = &report.trace;
    assert_eq!(trace.len(), report.iterations + 1, "{name}");
    assert!(report.iterations > 2 && trace[0].energy == 0.0, "{name}: {report:?}");
    assert!(trace.windows(2).all(|w| w[1].energy <= w[0].energy), "{name}: the energy rises");
    assert!(trace[report.iterations].energy < 0.0, "{name}");
}

fn surfaces() -> Vec<(&'static str, Soup, Space)> {
    let mut bumpy = shapes::torus(2.0, 0.9, 16, 10).unwrap();
    let mut disk = shapes::disk(4).unwrap();
    shapes::noise(&mut bumpy, 0.1, 3).unwrap();
    shapes::noise(&mut disk, 0.05, 3).unwrap();
    vec![
        ("torus", bumpy, Space::E2),
        ("disk", disk, Space::E2),
        ("genus 2", shapes::genus(2, 4).unwrap(), Space::H2),
        ("ellipsoid", shapes::ellipsoid([1.0, 1.2, 0.9], 3).unwrap(), Space::S2),
    ]
}

#[test]
fn the_energy_falls_at_every_step_in_every_space() {
    for (name, soup, space) in surfaces() {
        for scheme in [Scheme::Yamabe, Scheme::Inversive, Scheme::Thurston] {
            let report = descend(&soup, Class::new(scheme, space), Gradient::default(), 1e-10);
            println!("{name} {space} {scheme}: {} steps", report.iterations);
            assert!(report.converged(), "{name} {scheme}: {report:?}");
            goes_down(&report, name);
        }
    }
}

#[test]
fn the_energy_falls_by_every_rule_but_barzilai_borwein() {
    for (name, soup, space) in surfaces() {
        let class = Class::yamabe(space);
        for step in [StepRule::Stable, StepRule::Fixed(0.2), StepRule::Fixed(50.0)] {
            let area_normalised = space == Space::E2;
            let report = descend(&soup, class, Gradient { step, area_normalised }, 1e-4);
            assert!(report.converged(), "{name} {step:?}: {:?}", report.stop_reason);
            goes_down(&report, name);
            // No step is longer than asked for, and one that is not too long is taken as it is.
            if let StepRule::Fixed(h) = step {
                let sizes = || report.trace[1..].iter().map(|row| row.step_size);
                assert!(
                    sizes().all(|size| size <= h) && (h > 1.0 || sizes().any(|size| size == h)),
                    "{name}"
                );
            }
        }
        let plain = Gradient { step: StepRule::BarzilaiBorwein, ..Gradient::default() };
        assert!(descend(&soup, class, plain, 1e-10).converged(), "{name}");
    }
}

#[test]
fn the_energy_falls_down_to_the_last_digits() {
    // The changes of the energy are 1e-26 there, far below the rounding of u and of the energy itself.
    let soup = shapes::torus(2.0, 0.7, 12, 8).unwrap();
    let report = descend(&soup, Class::yamabe(Space::E2), Gradient::default(), 2e-14);
    assert!(report.converged(), "{:?}", report.stop_reason);
    goes_down(&report, "torus");
}
