//! Archives: every kind of result reads back bit for bit, is the same bytes on any number of threads, goes on as before, and what is cut off, damaged or
//! foreign is refused by name.

use ricci::archive::{self, Kept};
use ricci::canonical::{
    CircleDomain, CircleDomainOptions, QuotientOptions, Uniformization, circle_domain, uniformize,
};
use ricci::embed::{ChartOptions, Layout, LayoutOptions, charts};
use ricci::flow::{Options, flow};
use ricci::geometry::{Model, Space};
use ricci::harmonic::{Domain, FormsOptions, HarmonicForms, PeriodMatrix};
use ricci::matching::{MatchOptions, match_surfaces};
use ricci::mesh::{io::Soup, shapes};
use ricci::records::*;
use ricci::structure::{Atlas, AtlasOptions, atlas};
use ricci::{Class, Control, Error, Solution, Surface, Target};
use std::sync::Arc;

fn surface(soup: ricci::Result<Soup>) -> Surface {
    Surface::from_soup(&soup.unwrap()).unwrap()
}

/// The archive of an object, which reads back as an object with the same archive.
fn kept<T: Kept>(name: &str, object: &T) -> T {
    let bytes = archive::to_bytes(object);
    assert_eq!(archive::kind_of(&bytes).unwrap(), T::KIND);
    let again: T = archive::from_bytes(&bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!(archive::to_bytes(&again) == bytes, "{name}: other bytes after reading");
    again
}

fn flat(surface: &Surface, space: Space, threads: usize) -> Solution {
    let (target, options) =
        (Target::default_for(surface, space).unwrap(), Options { threads, ..Options::default() });
    flow(surface.clone(), Class::yamabe(space), &target, &options, &Control::new()).unwrap()
}

fn laid_out(metric: &Solution) -> Layout {
    Layout::of_solution(metric, &LayoutOptions::default(), &Control::new()).unwrap()
}

fn cases() -> [(&'static str, Surface, Space); 5] {
    [
        ("torus", surface(shapes::torus(2.0, 1.0, 20, 12)), Space::E2),
        ("disk", surface(shapes::disk(5)), Space::E2),
        ("genus 2", surface(shapes::genus(2, 4)), Space::H2),
        ("genus 2, cones", surface(shapes::genus(2, 4)), Space::E2),
        ("ellipsoid", surface(shapes::ellipsoid([1.6, 1.0, 0.7], 6)), Space::E2),
    ]
}

#[test]
fn metrics_and_layouts_read_back_and_go_on() {
    for (name, surface, space) in cases() {
        let (one, two) = (flat(&surface, space, 1), flat(&surface, space, 2));
        let [metric, other] = [one, two].map(MetricRecord::from);
        assert!(archive::to_bytes(&metric) == archive::to_bytes(&other), "{name}: threads");
        let again = kept(name, &metric).solution;
        let mut report = metric.solution.report().unwrap().clone();
        report.seconds = Default::default();
        assert_eq!(again.report(), Some(&report), "{name}");
        assert_eq!(again.is_unflipped(), metric.solution.is_unflipped(), "{name}");
        let control = Control::new();
        let maps = [&metric.solution, &again].map(|metric| metric.common_subdivision(&control).unwrap());
        assert_eq!(maps[0], maps[1], "{name}");
        let layouts = [&metric.solution, &again].map(laid_out);
        assert_eq!(layouts[0], layouts[1], "{name}");
        let [layout, _] = layouts;
        let record = LayoutRecord { metric, layout, model: Model::Klein };
        let LayoutRecord { layout, model, .. } = kept(name, &record);
        assert_eq!((layout.on_input(), model), (record.layout.on_input(), Model::Klein), "{name}");
        let [subdivision, _] = maps;
        let solution = &record.metric.solution;
        let lengths = solution.metric().lengths(solution.mesh()).unwrap();
        let second = Surface::intrinsic(solution.mesh().clone(), lengths, space);
        let second = MeshRecord::from(&second.unwrap());
        kept(name, &MapRecord { first: surface.clone(), second, subdivision: Arc::new(subdivision) });
        if space == Space::E2 {
            let charts = charts(layout.mesh(), |h| layout.uv(h), &ChartOptions::default(), &control);
            if let Ok(charts) = charts {
                kept(name, &ChartsRecord { metric: record.metric, layout, positions: None, charts });
            }
        }
    }
}

#[test]
fn meshes_keep_attributes_and_lengths() {
    let given = surface(shapes::torus(2.0, 1.0, 9, 6));
    let record = MeshRecord::from(&given);
    let again = kept("torus", &record);
    assert_eq!((again.mesh, again.positions, again.lengths), (record.mesh, record.positions, record.lengths));
}

#[test]
fn canonical_shapes_read_back() {
    for (name, surface) in [
        ("sphere", surface(shapes::icosphere(3))),
        ("torus", surface(shapes::torus(2.0, 1.0, 20, 12))),
        ("genus 2", surface(shapes::genus(2, 4))),
        ("annulus", surface(shapes::annulus(0.4, 1.0, 6, 24))),
    ] {
        let [one, two] = [1, 2].map(|threads| {
            let flow = Options { threads, ..Options::default() };
            let options = QuotientOptions { flow, ..QuotientOptions::default() };
            uniformize(&surface, &options, &Control::new()).unwrap()
        });
        assert!(archive::to_bytes(&one) == archive::to_bytes(&two), "{name}: threads");
        kept(name, &one);
    }
    let pants = surface(shapes::annulus(0.4, 1.0, 6, 24));
    let domain = circle_domain(&pants, &CircleDomainOptions::default(), &Control::new()).unwrap();
    assert_eq!(kept("circle domain", &domain).circles, domain.circles);
}

#[test]
fn forms_atlases_and_matchings_read_back() {
    let control = Control::new();
    let two = surface(shapes::genus(2, 4));
    let domain = Domain::new(&two, &control).unwrap();
    let forms = HarmonicForms::new(&domain, &FormsOptions::default(), &control).unwrap();
    let periods = Some(PeriodMatrix::new(&forms).unwrap());
    let again = kept("forms", &FormsRecord { forms: forms.clone(), dual: None, periods: periods.clone() });
    assert_eq!((&again.forms.forms, &again.periods), (&forms.forms, &periods));
    assert_eq!(Some(PeriodMatrix::new(&again.forms).unwrap()), periods);

    let hyperbolic = atlas(&two, &AtlasOptions::default(), &control).unwrap();
    let again = kept("atlas", &hyperbolic);
    assert_eq!((again.charts, again.transitions), (hyperbolic.charts, hyperbolic.transitions));

    let [source, target] = [[1.6, 1.0, 0.7], [1.0, 1.3, 0.8]].map(|axes| surface(shapes::ellipsoid(axes, 6)));
    let matching = match_surfaces(&source, &target, &MatchOptions::default(), &control).unwrap();
    let record =
        MatchingRecord { matching, source, target, quality: None, point_error: 0.0, mirrored: false };
    let again = kept("matching", &record);
    assert_eq!(again.matching, record.matching);
    let overlaid = |record: &MatchingRecord| record.matching.domain.overlay(1, &control).unwrap();
    assert_eq!(overlaid(&again), overlaid(&record));
}

#[cfg(all(feature = "quads", feature = "splines", feature = "json"))]
#[test]
fn seamless_metrics_quads_and_splines_read_back() {
    use ricci::quads::{QuadOptions, QuadSize, quad_layout, quad_mesh};
    use ricci::seamless::{SeamlessOptions, seamless};
    use ricci::spline::{LayoutFitOptions, fit_quad_layout};
    let control = Control::new();
    let torus = surface(shapes::torus(2.0, 1.0, 20, 12));
    let metric = seamless(&torus, &SeamlessOptions::default(), &control).unwrap();
    let again = kept("seamless", &metric);
    assert_eq!(again.fingerprint(), metric.fingerprint());
    let options = QuadOptions { size: QuadSize::Quads(100), ..QuadOptions::default() };
    let quads = [&metric, &again].map(|metric| quad_mesh(metric, &options, &control).unwrap());
    assert_eq!(quads[0], quads[1]);
    let [mesh, _] = quads;
    kept("quads", &QuadsRecord { positions: mesh.positions(&metric.solution), mesh });
    let options = QuadOptions { size: QuadSize::Coarse, ..options };
    let layout = quad_layout(&again, &options, &control).unwrap();
    let record = QuadLayoutRecord { layout, positions: None, metric: metric.fingerprint() };
    let layout = kept("layout", &record).layout;
    let options = LayoutFitOptions { most_spans: 4, ..LayoutFitOptions::default() };
    let fits = [(&metric, &record.layout), (&again, &layout)]
        .map(|(m, l)| fit_quad_layout(m, l, &options, &control));
    let [one, two] = fits.map(|fit| QuadSplineRecord {
        fit: fit.unwrap(),
        diagonal: 6.0,
        tolerance: 0.01,
        converged: true,
    });
    assert!(archive::to_bytes(&one) == archive::to_bytes(&two));
    let points = &kept("quad spline", &one).fit.spline;
    assert_eq!(points.control_points(), one.fit.spline.control_points());
}

#[test]
fn what_is_cut_off_damaged_or_foreign_is_refused_by_name() {
    let torus = surface(shapes::torus(2.0, 1.0, 9, 6));
    let bytes = archive::to_bytes(&MetricRecord::from(flat(&torus, Space::E2, 1)));
    let read = |bytes: &[u8]| archive::from_bytes::<MetricRecord>(bytes).map(|_| ()).unwrap_err();
    for n in (0..bytes.len()).step_by(7) {
        let error = read(&bytes[..n]);
        assert!(
            matches!(&error, Error::Parse { message, .. } if message.contains("cut off")),
            "{n}: {error}"
        );
    }
    for at in (40..bytes.len()).step_by(11) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 4;
        let error = read(&damaged);
        assert!(matches!(&error, Error::Parse { .. }), "{at}: {error}");
    }
    let error = archive::from_bytes::<LayoutRecord>(&bytes).map(|_| ()).unwrap_err();
    assert!(error.to_string().contains("holds a metric, not a layout"), "{error}");
    assert!(matches!(read(b"solid torus\nfacet"), Error::UnknownFormat { .. }));
    let mut newer = bytes.clone();
    newer[12] = 9;
    assert!(read(&newer).to_string().contains("format 9; this library reads format 1"));
}

#[test]
fn files_are_the_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("torus.metric");
    let torus = surface(shapes::torus(2.0, 1.0, 9, 6));
    let record = MetricRecord::from(flat(&torus, Space::E2, 1));
    archive::save(&record, &path).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), archive::to_bytes(&record));
    let again: MetricRecord = archive::load(&path).unwrap();
    assert_eq!(again.solution.metric(), record.solution.metric());
    let error = archive::load::<MetricRecord>(&folder.path().join("none")).map(|_| ()).unwrap_err();
    assert!(matches!(error, Error::Io { .. }) && error.to_string().contains("none"));
}

/// The file of `tests/archives` is written to the same bytes again.
fn unchanged<T: Kept>(name: &str) {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/archives/{name}.ricci"));
    let object: T = archive::load(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!(archive::to_bytes(&object) == std::fs::read(&path).unwrap(), "{name}");
}

#[test]
fn files_of_this_format_keep_their_bytes() {
    unchanged::<MeshRecord>("mesh");
    unchanged::<MetricRecord>("metric");
    unchanged::<LayoutRecord>("layout");
    unchanged::<ChartsRecord>("charts");
    unchanged::<MapRecord>("map");
    unchanged::<Uniformization>("uniformization");
    unchanged::<CircleDomain>("circle-domain");
    unchanged::<FormsRecord>("forms");
    unchanged::<MatchingRecord>("matching");
    unchanged::<Atlas>("structure");
}

#[cfg(all(feature = "quads", feature = "splines", feature = "json"))]
#[test]
fn files_of_quads_and_splines_keep_their_bytes() {
    unchanged::<ricci::seamless::Seamless>("seamless");
    unchanged::<QuadsRecord>("quads");
    unchanged::<QuadLayoutRecord>("quad-layout");
    unchanged::<QuadSplineRecord>("quad-spline");
    unchanged::<SplineRecord>("spline");
}
