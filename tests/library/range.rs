//! Metrics whose lengths leave the range of f64, and variables in double-double precision.

use crate::common::Random;
use crate::common::flips::{
    SCHEMES, exp, in_the_middle, measure, reach, scaled_sides, started, stretched, two_sum,
};
use crate::common::flow::surface;
use ricci::Error;
use ricci::flow::{Options, curvature_derivative};
use ricci::geometry::{DoubleDouble, Space};
use ricci::mesh::{EdgeId, VertexId, shapes};
use ricci::metric::{Class, Scheme, initial_metric};

/// Flows reach metrics whose lengths and areas leave the range of f64 like others: angles need only ratios within one triangle.
#[test]
fn lengths_beyond_doubles_are_no_limit_of_the_flow() {
    let (surface, by_height) = stretched(10, 1e4);
    let target = in_the_middle(&surface.0, &by_height);
    for scheme in SCHEMES {
        let mut flow = started(&surface, (Space::E2, scheme), &Options::default());
        let report = reach(&mut flow, &target, "cones in the middle");
        let (mesh, metric) = (flow.mesh(), flow.metric());
        let (low, high) = metric.u.iter().fold((f64::MAX, f64::MIN), |(a, b), &u| (a.min(u), b.max(u)));
        println!("cones in the middle, {scheme}: {} steps, u from {low:.0} to {high:.0}", report.iterations);
        assert!(report.max_curvature_error <= 1e-10 && report.gauss_bonnet <= 1e-10, "{report:?}");
        assert!(high - low > 900.0 && high > 400.0, "{scheme}: within the range of doubles");
        // Derivative and curvature have no limit of range.
        let derivative = curvature_derivative(mesh, metric).unwrap();
        assert!(derivative.iter().all(|(_, _, x)| x.is_finite()));
        assert!(metric.angle_defects(mesh).unwrap().iter().all(|k| k.is_finite()));
        // The area, about e^900, leaves the range of f64; in another unit it does not.
        assert!(matches!(metric.curvature(mesh), Err(Error::Argument { what: "u", .. })), "{scheme}");
        let mut smaller = metric.clone();
        for v in mesh.vertices() {
            let (u, lost) = two_sum(metric.u[v], -500.0);
            (smaller.u[v], smaller.u_low[v]) = two_sum(u, lost + metric.u_low[v]);
        }
        let curvature = smaller.curvature(mesh).unwrap();
        assert!(curvature.area.is_finite() && curvature.area > 0.0 && curvature.broken.is_empty());
        assert!(mesh.vertices().all(|v| (curvature.at[v] - target[v]).abs() < 1e-9));
        // Lengths have a limit, and the first edge beyond it is named.
        for refused in [smaller.lengths(mesh).map(drop), smaller.differences(mesh).map(drop)] {
            let Err(Error::EdgeWeight { edge, .. }) = refused else { panic!("{scheme}: {refused:?}") };
            let [a, b] = mesh.ends(EdgeId::from(edge)).map(|v| smaller.u[v]);
            assert!(a.min(b) < -650.0, "{scheme}: edge {edge} is not out of range");
        }
        assert!(matches!(smaller.radii(), Err(Error::Domain { .. })), "{scheme}");
    }
}

/// Lengths and half-perimeter differences keep the low part of u, for all vertex types and weights, including touching circles (η = 1)
/// and triangles of circles that are nearly broken.
#[test]
fn lengths_keep_both_halves_of_u() {
    let (mesh, lengths) = surface(&shapes::icosphere(2).unwrap());
    let mut random = Random::new(21);
    let mut worst = [0.0f64; 2];
    for scheme in Scheme::ALL {
        for (size, shift) in [(1e-3, 0.0), (0.3, 0.0), (0.3, -400.0), (0.3, 300.0)] {
            let mut metric =
                initial_metric(&mesh, &lengths, Space::E2, Class::new(scheme, Space::E2)).unwrap().metric;
            for v in mesh.vertices() {
                metric.u[v] += shift + size * random.symmetric();
                metric.u_low[v] = 0.4 * random.symmetric() * f64::EPSILON * metric.u[v].abs();
            }
            // Lengths of this size leave the range of f64; the differences follow from the angles.
            let [found, low, r] = if shift == 0.0 {
                let r = metric.differences(&mesh).unwrap();
                [
                    metric.lengths(&mesh).unwrap().into_vec(),
                    metric.length_remainders(&mesh).unwrap().into_vec(),
                    r.iter().flatten().copied().collect(),
                ]
            } else {
                let curvature =
                    metric.curvature(&mesh).unwrap_or_else(|error| panic!("{scheme} {shift}: {error}")).at;
                let plain = measure(&mesh, &metric).curvature;
                assert!(
                    mesh.vertices().all(|v| (curvature[v] - plain[v.index()]).abs() < 1e-13),
                    "{scheme} {shift}"
                );
                continue;
            };
            for f in mesh.faces() {
                let (sides, top) = scaled_sides(&mesh, &metric, f);
                let own = exp(top.into());
                let exact = sides.map(|(high, low)| (DoubleDouble::from(high) + low.into()) * own);
                for (k, e) in mesh.opposite_edges(f).into_iter().enumerate() {
                    let ours = DoubleDouble::from(found[e.index()]) + low[e.index()].into();
                    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                    let half = (exact[i] + exact[j] - exact[k]) * 0.5.into();
                    let miss = (DoubleDouble::from(r[3 * f.index() + k]) - half).high.abs();
                    worst[0] = worst[0].max(((ours - exact[k]) / exact[k]).high.abs());
                    worst[1] = worst[1].max((miss - 1e-20 * exact[k].high) / half.high.abs());
                }
            }
        }
    }
    println!("lengths to {:.1e}, differences to {:.1e}", worst[0], worst[1]);
    assert!(worst[0] < 1e-20 && worst[1] < 4.0 * f64::EPSILON, "{worst:?}");
}

#[test]
fn what_u_loses_is_less_than_an_ulp() {
    let (mesh, lengths) = surface(&shapes::icosphere(1).unwrap());
    let metric = initial_metric(&mesh, &lengths, Space::E2, Class::inversive(Space::E2)).unwrap().metric;
    metric.check(&mesh).unwrap();
    let v = VertexId(5);
    for (low, sound) in [(0.4, true), (2.0, false), (f64::NAN, false), (f64::INFINITY, false)] {
        let mut metric = metric.clone();
        metric.u_low[v] = low * f64::EPSILON * metric.u[v].abs();
        let result = metric.check(&mesh);
        assert_eq!(result.is_ok(), sound, "{low}");
        assert!(sound || matches!(result, Err(Error::Argument { what: "u_low", .. })), "{result:?}");
        assert_eq!(metric.lengths(&mesh).is_ok(), sound, "{low}");
    }
}
