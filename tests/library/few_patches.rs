//! Splines with few patches, and the cones over which they are tried.

use crate::common;
use ricci::geometry::Space;
use ricci::mesh::shapes;
use ricci::seamless::placed_cones;
use ricci::spline::{FewPatchesOptions, LayoutFit, LayoutFitOptions, fit_few_patches};
use ricci::{Control, Error, Surface};

fn fitted(surface: &Surface, threads: usize) -> LayoutFit {
    let fit = LayoutFitOptions { threads, ..LayoutFitOptions::default() };
    fit_few_patches(surface, &FewPatchesOptions { fit, ..FewPatchesOptions::default() }, &Control::new())
        .unwrap()
}

/// The quarter turns of placed cones add up to those of the surface, and corners of patches have 3 to 6 of them.
#[test]
fn placed_cones_are_corners_of_patches() {
    for (name, soup, n) in [
        ("ellipsoid", shapes::ellipsoid([1.0, 0.6, 0.3], 10).unwrap(), 24),
        ("torus", shapes::torus(2.0, 0.8, 30, 15).unwrap(), 16),
        ("genus 3", shapes::genus(3, 6).unwrap(), 24),
    ] {
        let surface = Surface::from_soup(&soup).unwrap();
        let cones = placed_cones(&surface, n, &Control::new()).unwrap();
        assert!(cones.len() <= n, "{name}");
        assert!(cones.iter().all(|cone| [3, 5, 6].contains(&cone.valence)), "{name}: {cones:?}");
        let total: i64 = cones.iter().map(|cone| 4 - i64::from(cone.valence)).sum();
        assert_eq!(total, 4 * surface.mesh().euler(), "{name}");
    }
    // Three corners of three patches each have three quarter turns, of the eight that a sphere has.
    let sphere = Surface::from_soup(&shapes::ellipsoid([1.0; 3], 6).unwrap()).unwrap();
    let refused = placed_cones(&sphere, 3, &Control::new());
    assert!(
        matches!(&refused, Err(Error::TargetKind { message, .. }) if message.contains("more do")),
        "{refused:?}"
    );
}

#[test]
fn a_surface_of_genus_2_has_few_patches_for_any_number_of_threads() {
    let surface = Surface::from_soup(&shapes::genus(2, 6).unwrap()).unwrap();
    let [one, two] = [1, 2].map(|threads| fitted(&surface, threads));
    println!("{} patches, distances up to {:.1e}", one.layout.patches.len(), one.fit.max());
    assert!(LayoutFitOptions::default().is_met_by(&one.fit), "{:e}", one.fit.max());
    assert!(one.layout.patches.len() <= 40);
    assert_eq!(one.fit.spline.control_points(), two.fit.spline.control_points());
}

/// The handles of these surfaces are so thin that means of neighbours are outside: quads that were moved there turned over, and so did the splines.
#[test]
fn thin_handles_do_not_fold() {
    let Some(soups) = common::named("good", &["lawson2498", "eight_766"]) else { return };
    for (name, soup) in soups {
        let found = fitted(&Surface::from_soup(&soup).unwrap(), 0);
        let patches = found.layout.patches.len();
        println!("{name}: {patches} patches, distances up to {:.1e}", found.fit.max());
        assert!(found.fit.is_within(1e-3) && patches <= 40, "{name}: {patches}, {:e}", found.fit.max());
    }
}

#[test]
fn what_has_no_positions_is_refused() {
    let two = Surface::from_soup(&shapes::genus(2, 3).unwrap()).unwrap();
    let bare = Surface::intrinsic(two.mesh().clone(), two.lengths().clone(), Space::E2);
    let options = FewPatchesOptions::default();
    let refused = bare.and_then(|bare| fit_few_patches(&bare, &options, &Control::new()));
    assert!(matches!(refused.err(), Some(Error::Layout(message)) if message.contains("positions")));
}
