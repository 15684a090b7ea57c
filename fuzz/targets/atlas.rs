//! Atlases of drawn surfaces and their files: charts and transitions that fit together, in JSON without a NaN.
#![no_main]

#[path = "../../apps/src/structure/file.rs"]
mod file;

use file::AtlasFile;
use ricci::mesh::VertexId;
use ricci::structure::{AffineSource, AtlasOptions, ChartKind, Structure, atlas};
use ricci::{Control, Error, flow};
use serde_json::Value;

/// Steps of a flow, at most: one to a target that it reaches takes fewer.
const MOST_STEPS: u8 = 24;

const STRUCTURES: [Structure; 5] = [
    Structure::Conformal,
    Structure::Spherical,
    Structure::Affine,
    Structure::Hyperbolic,
    Structure::Projective,
];

/// Every number of a document is one: a NaN would be `null`.
fn numbers(value: &Value) {
    match value {
        Value::Null => panic!("a number that is none"),
        Value::Array(entries) => entries.iter().for_each(numbers),
        Value::Object(fields) => fields.values().for_each(numbers),
        _ => {}
    }
}

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let mut bytes = data.iter().copied();
    let (Some(how), Some(steps)) = (bytes.next(), bytes.next()) else { return };
    let singular = bytes.next().filter(|b| *b > 200).map(|b| VertexId::from(usize::from(b - 200)));
    let Some(surface) = ricci_fuzz::surfaces::surface(data, &mut bytes) else { return };
    let options = AtlasOptions {
        structure: STRUCTURES[usize::from(how) % 5],
        charts: if how & 32 == 0 { ChartKind::Stars } else { ChartKind::Patches },
        source: if how & 64 == 0 { AffineSource::Flow } else { AffineSource::Form },
        radius: (how & 128 != 0).then_some(0.5),
        singular,
        quads: None,
        flow: flow::Options {
            max_iterations: usize::from(steps % MOST_STEPS),
            threads: 1,
            ..flow::Options::default()
        },
    };
    let atlas = match atlas(&surface, &options, &Control::new()) {
        Ok(atlas) => atlas,
        Err(error) => {
            assert!(!matches!(error, Error::Connectivity { .. }), "{error}");
            return;
        }
    };
    let document = serde_json::to_value(AtlasFile::new(&atlas)).unwrap();
    numbers(&document);
    for chart in &atlas.charts {
        assert_eq!(chart.vertices.len(), chart.coordinates.len());
        assert!(chart.corners.iter().flatten().all(|&k| (k as usize) < chart.vertices.len()));
        assert!(chart.faces.iter().all(|f| f.index() < atlas.mesh.n_faces()));
    }
    for t in &atlas.transitions {
        assert!(t.from < t.to || t.from == t.to);
        let [from, to] = [t.from, t.to].map(|k| &atlas.charts[k as usize]);
        for &[a, b] in &t.pairs {
            assert_eq!(from.vertices[a as usize], to.vertices[b as usize]);
        }
    }
    for f in atlas.mesh.faces() {
        let places = atlas.places(f, [0.2, 0.3, 0.5]).unwrap();
        assert!(places.iter().flat_map(|p| p.coordinates).all(|x| x.is_finite()));
    }
});
