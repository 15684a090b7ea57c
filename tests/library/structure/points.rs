//! Coordinates of points in charts.

use crate::structure::{all_options, glued, made, of, options};
use ricci::mesh::shapes::{self, SplitMix64};
use ricci::mesh::{FaceId, VertexId};
use ricci::structure::{ChartKind, FaceLift, Structure};

#[test]
fn points_have_the_same_place_by_every_chart() {
    let mut random = SplitMix64::new(4);
    for surface in [
        of(shapes::ellipsoid([1.0, 2.0, 3.0], 2)),
        of(shapes::torus(2.0, 0.7, 12, 8)),
        of(shapes::genus(2, 2)),
        glued(shapes::one_vertex(2)),
        of(shapes::disk(4)),
    ] {
        for options in all_options(&surface) {
            let found = made(&surface, &options);
            let (mut compared, mut most): (usize, f64) = (0, 0.0);
            for _ in 0..60 {
                let f = FaceId::from((random.unit() * found.mesh.n_faces() as f64) as usize);
                let places = found.places(f, [0; 3].map(|_| 0.01 + random.unit())).unwrap();
                for p in &places {
                    for q in &places {
                        let image = found.carry(p.lift, q.lift, p.coordinates).unwrap();
                        let off = [0, 1].map(|k| image[k] - q.coordinates[k]);
                        let chart = &found.charts[q.lift.chart as usize];
                        let size = chart.coordinates.iter().map(|z| z[0].hypot(z[1])).fold(0.0, f64::max);
                        most = most.max(off[0].hypot(off[1]) / size);
                        compared += 1;
                    }
                }
            }
            assert!(most < 1e-10, "{} {:?}: {most:e}", options.structure, options.charts);
            assert!(compared > 10, "{compared}");
        }
    }
}

#[test]
fn points_and_lifts_that_do_not_exist_are_refused() {
    let found = made(&of(shapes::genus(2, 1)), &options(Structure::Conformal, ChartKind::Stars));
    let far = FaceId::from(found.mesh.n_faces());
    assert!(found.places(far, [1.0, 0.0, 0.0]).is_err() && found.lifts(far).is_err());
    for weights in [[0.0; 3], [1.0, -1.0, 1.0], [f64::NAN, 1.0, 1.0]] {
        assert!(found.places(FaceId(0), weights).is_err());
    }
    let all = found.lifts(FaceId(0)).unwrap();
    let other = (0..).map(FaceId::from).find(|&f| found.lifts(f).unwrap()[0].chart != all[0].chart).unwrap();
    assert!(found.between(all[0], found.lifts(other).unwrap()[0]).is_err());
    assert!(found.between(all[0], FaceLift { chart: u32::MAX, face: 0 }).is_err());
    // The place of a corner of a face is that of the vertex.
    let values = found
        .evaluate(FaceId(0), [0.0, 2.0, 0.0], |at| {
            let chart = &found.charts[at.lift.chart as usize];
            let v = chart.corners[at.lift.face as usize][1] as usize;
            assert_eq!(at.coordinates, chart.coordinates[v]);
            chart.vertices[v]
        })
        .unwrap();
    let expected: VertexId = found.mesh.face_vertices(FaceId(0))[1];
    assert!(values.len() == all.len() && values.iter().all(|v| *v == expected));
}
