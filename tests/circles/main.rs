//! Circle domains, by theorem
use ricci::canonical::{CircleDomain, CircleDomainOptions, circle_domain};
use ricci::mesh::shapes;
use ricci::{Control, Surface};

fn show(name: &str, d: &CircleDomain, s: f64) {
    let dev = d.circles.iter().map(|c| c.deviation).fold(0.0, f64::max);
    println!("{name}: conv {} {} it {} flips {} K {:.1e} {:.1e} halved {} crossed {} gap {:.1e} dev {dev:.1e} flipped {} deg {} cons {:.1e} {:.1e} radius {:.2} mod {:?} {:?} n {} {s:.2}s",
        d.report.converged, d.report.stop_reason, d.report.iterations, d.report.flips, d.report.max_curvature_error, d.report.domain_curvature_error,
        d.report.halved_edges, d.report.crossed_edges, d.report.least_gap, d.layout.flipped.len(), d.layout.degenerate.len(), d.layout.consistency(), d.layout.local_consistency, d.layout.radius, d.modulus, d.torus_modulus, d.circles.len());
}

struct Say;
impl log::Log for Say {
    fn enabled(&self, _: &log::Metadata) -> bool { true }
    fn log(&self, r: &log::Record) { println!("  {}", r.args()); }
    fn flush(&self) {}
}

#[test]
fn scratch() {
    if std::env::var("LOG").is_ok() { log::set_logger(&Say).unwrap(); log::set_max_level(log::LevelFilter::Debug); }
    let pattern = std::env::var("PATTERN").unwrap_or_default();
    if pattern.is_empty() {
        for (name, soup) in [
            ("annulus", shapes::annulus(0.5, 1.0, 48, 5).unwrap()),
            ("disk1", shapes::disk(1).unwrap()),
            ("disk", shapes::disk(8).unwrap()),
        ] {
            let s = Surface::from_soup(&soup).unwrap();
            let t = std::time::Instant::now();
            match circle_domain(&s, &CircleDomainOptions::default(), &Control::new()) {
                Ok(d) => show(name, &d, t.elapsed().as_secs_f64()),
                Err(e) => println!("{name}: {e}"),
            }
        }
        return;
    }
    for name in pattern.split(',') {
        let s = Surface::read(format!("/work/shared/meshes/good/{name}.obj")).unwrap();
        let t = std::time::Instant::now();
        match circle_domain(&s, &CircleDomainOptions::default(), &Control::new()) {
            Ok(d) => show(name, &d, t.elapsed().as_secs_f64()),
            Err(e) => println!("{name}: {e} {:.1}s", t.elapsed().as_secs_f64()),
        }
    }
}
