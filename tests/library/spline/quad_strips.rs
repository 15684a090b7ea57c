//! Spaces of splines over four-sided patches whose strips have different numbers of spans, and whose creases end or turn.

use super::quad::{any_spline, block, cells, jumps, slab};
use ricci::Error;
use ricci::spline::{PatchLayout, QuadSplineSpace};
use std::sync::Arc;

#[test]
fn tangent_planes_are_continuous_where_strips_have_different_spans() {
    for quads in [cells(&block([3, 1, 1])), slab(), cells(&block([2, 2, 1]))] {
        let layout = quads.layout();
        // Each strip of patches by its least arc, with 1, 2 or 3 spans in turn.
        let mut strip: Vec<usize> = (0..layout.arcs().len()).collect();
        for _ in 0..strip.len() {
            for sides in layout.patches() {
                for [a, b] in [[0, 2], [1, 3]].map(|pair| pair.map(|k| sides[k].arc as usize)) {
                    let least = strip[a].min(strip[b]);
                    (strip[a], strip[b]) = (least, least);
                }
            }
        }
        let mut strips = strip.clone();
        strips.sort_unstable();
        strips.dedup();
        let spans = strip.iter().map(|s| 1 + strips.binary_search(s).unwrap() % 3).collect();
        let space = Arc::new(QuadSplineSpace::with_spans(layout, spans).unwrap());
        let spans = space.spans();
        assert!(strips.len() > 1 && spans.contains(&1) && spans.contains(&2));
        let [gap, turn] = jumps(&any_spline(&space));
        assert!(gap < 1e-13 && turn < 1e-9, "{} patches: {gap}, {turn}", quads.faces.len());
    }
    let mut unequal = vec![1; 12];
    unequal[0] = 2;
    let cube = cells(&block([1, 1, 1])).layout();
    assert!(matches!(QuadSplineSpace::with_spans(cube, unequal), Err(Error::Spline { what: "patch", .. })));
}

#[test]
fn a_crease_may_end_inside_and_turn_by_any_angle() {
    let quads = slab();
    let size = |layout: PatchLayout| QuadSplineSpace::new(layout, 1).unwrap();
    // A crease along one side of a patch ends at both of its ends.
    let crease = [[quads.faces[0][0], quads.faces[0][1]]];
    let layout = PatchLayout::from_quads(quads.positions.len(), &quads.faces, &crease).unwrap();
    assert!(size(layout.clone()).dimension() > quads.space(1).dimension());
    let [gap, _] = jumps(&any_spline(&Arc::new(size(layout.clone()))));
    assert!(gap < 1e-13, "{gap}");
    for angle in [1.0, 2.4] {
        let turned = layout.clone().with_angles(&vec![[angle; 4]; quads.faces.len()]);
        let [gap, _] = jumps(&any_spline(&Arc::new(size(turned))));
        assert!(gap < 1e-13, "{gap}");
    }
}
