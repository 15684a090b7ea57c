//! Files of splines with holes: tampered ones are refused, and the charts of one point agree.

use crate::surface_fit::sample;
use ricci::spline::{Parameter, Spline};
use ricci::{Control, Error};

fn refusal(text: &str) -> Error {
    match Spline::from_json(text, "s.json") {
        Err(error) => error,
        Ok(_) => panic!("accepted"),
    }
}

#[test]
fn tampered_holes_are_refused_by_name() {
    let text = sample().spline.to_json();
    let (before, hole) = text.split_at(text.find("\"hole\":").unwrap());
    let hole = hole.to_string();
    let with = |from: &str, to: &str| {
        assert!(hole.contains(from), "{from}");
        refusal(&format!("{before}{}", hole.replacen(from, to, 1)))
    };
    let patches = sample().spline.space().patches().len();
    for turns in ["0", "-2", "65537", "99999999999"] {
        let error = with("\"turns\":3", &format!("\"turns\":{turns}"));
        assert!(matches!(error, Error::Argument { what: "turns of a hole", .. }), "{error}");
    }
    // The number is written as 3.0.
    assert!(matches!(with("\"turns\":3", "\"turns\":2.5"), Error::Parse { .. }));
    for radius in ["0.0", "-1.0"] {
        let error = with("\"radius\":", &format!("\"radius\":{radius},\"was\":"));
        assert!(matches!(error, Error::Argument { what: "radius of a hole", .. }), "{error}");
    }
    assert!(matches!(with("\"radius\":", "\"radius\":1e999,\"was\":"), Error::Parse { .. }));
    assert!(matches!(with("\"radius\":", "\"width\":"), Error::Parse { .. }));
    for inner in ["0.0", "1.0", "-0.5"] {
        let error = with("\"inner\":", &format!("\"inner\":{inner},\"was\":"));
        assert!(matches!(error, Error::Argument { what: "inner part of a hole", .. }), "{error}");
    }
    let sector = |from: &str, to: &str| {
        let error = with(from, to);
        assert!(matches!(error, Error::Spline { what: "sector of a hole", index: _, .. }), "{error}");
    };
    // A patch that does not exist, and maps that are no similarities or have no size.
    let last = hole.split("\"patch\":").last().unwrap().split(',').next().unwrap();
    sector(&format!("{{\"patch\":{last},"), &format!("{{\"patch\":{patches},"));
    let map = hole.split("\"to\":[[").nth(1).unwrap().split(']').next().unwrap();
    sector(&format!("\"to\":[[{map}]"), "\"to\":[[1.0, 2.0, 0.0]");
    let whole = hole.split("\"to\":").nth(1).unwrap().split('}').next().unwrap();
    sector(&format!("\"to\":{whole}}}"), "\"to\":[[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]}");
    let sectors = hole.split("\"sectors\":").nth(1).unwrap().split(",\"coefficients\"").next().unwrap();
    assert!(matches!(with(sectors, "[]"), Error::Argument { what: "turns of a hole", .. }));
    // Coefficients that are too few, too many, or no numbers.
    let first = hole.split("\"coefficients\":[[").nth(1).unwrap().split(']').next().unwrap();
    let coefficient =
        |to: &str| with(&format!("\"coefficients\":[[{first}],"), &format!("\"coefficients\":[{to}"));
    for count in ["", "[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], "] {
        let error = coefficient(count);
        assert!(matches!(error, Error::Argument { what: "coefficients of a hole", .. }), "{error}");
    }
    assert!(matches!(coefficient("[0.0, NaN, 0.0], "), Error::Parse { .. }));
    assert!(matches!(coefficient("[0.0, 0.0], "), Error::Parse { .. }));
    assert!(matches!(with("\"coefficients\":", "\"coefficients\":[],\"was\":"), Error::Argument { .. }));
    for end in (0..hole.trim_end().len()).step_by(97) {
        assert!(matches!(refusal(&format!("{before}{}", &hole[..end])), Error::Parse { .. }), "{end}");
    }
}

#[test]
fn all_charts_of_a_point_agree() {
    let spline = &sample().spline;
    let (space, control) = (spline.space(), Control::new());
    let mut pairs = Vec::new();
    for (at, supports) in space.supports().iter().enumerate() {
        let corners = space.patches()[at].corners();
        for k in 0..3 {
            for share in [0.1, 0.5, 0.8] {
                let [x, y] = [0, 1].map(|x| (1.0 - share) * corners[k][x] + share * corners[(k + 1) % 3][x]);
                let here = Parameter { patch: at as u32, x, y };
                for support in supports.iter().filter(|support| support.patch as usize != at) {
                    let [[a, b, u], [c, d, v]] = support.to;
                    let det = a * d - b * c;
                    let (p, q) = (x - u, y - v);
                    let there = Parameter {
                        patch: support.patch,
                        x: (d * p - b * q) / det,
                        y: (a * q - c * p) / det,
                    };
                    // Places outside the patch are refused.
                    if spline.point(there).is_ok() {
                        pairs.push((here, there, [[a, b], [c, d]]));
                    }
                }
            }
        }
    }
    assert!(pairs.len() > 3 * space.patches().len(), "{}", pairs.len());
    let evaluate = |places: Vec<Parameter>| spline.evaluate(&places, 2, 0, &control).unwrap();
    let here = evaluate(pairs.iter().map(|pair| pair.0).collect());
    let there = evaluate(pairs.iter().map(|pair| pair.1).collect());
    let (mut worst, mut size) = ([0.0f64; 3], [0.0f64; 3]);
    for ((a, b), (.., [[xx, xy], [yx, yy]])) in here.iter().zip(&there).zip(&pairs) {
        for k in 0..3 {
            let [fx, fy] = [a.first[0][k], a.first[1][k]];
            let [gxx, gxy, gyy] = [a.second[0][k], a.second[1][k], a.second[2][k]];
            // The derivatives by the coordinates of the other chart.
            let first = [fx * xx + fy * yx, fx * xy + fy * yy];
            let second = [
                gxx * xx * xx + 2.0 * gxy * xx * yx + gyy * yx * yx,
                gxx * xx * xy + gxy * (xx * yy + xy * yx) + gyy * yx * yy,
                gxx * xy * xy + 2.0 * gxy * xy * yy + gyy * yy * yy,
            ];
            let mut compare = |order: usize, p: f64, q: f64| {
                worst[order] = worst[order].max((p - q).abs());
                size[order] = size[order].max(q.abs());
            };
            compare(0, a.point[k], b.point[k]);
            (0..2).for_each(|x| compare(1, first[x], b.first[x][k]));
            (0..3).for_each(|x| compare(2, second[x], b.second[x][k]));
        }
    }
    let relative = [0, 1, 2].map(|order| worst[order] / size[order]);
    eprintln!("{} pairs, {relative:?} of {size:?}", pairs.len());
    // Differences are relative to the largest derivative of the order.
    let limits = [1e-12, 1e-10, 1e-9];
    assert!((0..3).all(|order| relative[order] < limits[order]), "{relative:?}");
}
