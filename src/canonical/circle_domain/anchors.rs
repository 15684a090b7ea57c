//! Places crossings on edges at hubs, such that those of a loop lie on its circle.
//!
//! ```text
//!                 k          An edge ij of a loop that has been flipped crosses the edge from the hub h to a vertex k outside the circle. As a
//!               / | \        line of the class it does so at M = v_k + η_hk v_h, which is orthogonal to v_h, wherever i and j are: in the
//!             i ——M—— j      plane that is a point of the chord. It is put where the line meets the circle instead, and the crossings between
//!               \ | /        k and M move along: c = α v_k + β M has the weights α and β also from the new place of M.
//!                 h
//! ```

/// An edge of the final triangulation at a hub, in a frame of the space.
pub(super) struct HubEdge {
    /// η.
    pub eta: f64,
    /// True if the ends are hubs.
    pub is_hub: [bool; 2],
    /// The position of each end is this times its vector: `e^u` in E², negative for a hub whose circle has the surface inside; `2 e^u/d` in
    /// H².
    pub scale: [f64; 2],
}

impl HubEdge {
    /// The weights of the *anchors* of the ends, which add up to 1, from the weights of the positions of the `ends` in a crossing. The anchor
    /// of a hub is the point where the edge leaves its circle, that of a point is the point.
    pub fn weights(&self, ends: [f64; 2]) -> [f64; 2] {
        let HubEdge { eta, is_hub, scale } = *self;
        // The crossing as a combination of the vectors, and the sum of the weights of positions that each anchor is.
        let [a, b] = [0, 1].map(|i| ends[i] * scale[i].abs());
        let own = |i: usize| {
            if is_hub[i] { eta / scale[i] + 1.0 / scale[1 - i] } else { 1.0 / scale[i] }
        };
        let parts = match is_hub {
            [true, true] => {
                let d = (eta - 1.0) * (eta + 1.0);
                [(a * eta - b) / d, (b * eta - a) / d]
            }
            [true, false] => [a / eta, b - a / eta],
            [false, true] => [a - b / eta, b / eta],
            [false, false] => [a, b],
        };
        let weights = [0, 1].map(|i| (parts[i] * own(i)).max(0.0));
        let sum = weights[0] + weights[1];
        weights.map(|w| w / sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle of radius 1 about 0 and a point at distance 3: η e^u = (9 − 1)/2. The line of the class crosses the edge at 2/(3 + 1/3).
    #[test]
    fn a_loop_lies_at_the_anchor_of_its_hub() {
        let (u, eta) = (1.7f64, 4.0 / 1.7);
        let edge = HubEdge { eta, is_hub: [true, false], scale: [1.0, u] };
        let along = 2.0 / (3.0 + 1.0 / 3.0) / 3.0;
        let [hub, point] = edge.weights([1.0 - along, along]);
        assert!((hub - 1.0).abs() < 1e-15 && point < 1e-15);
        // What crosses nearer to the point stays nearer to it, and the point itself stays.
        let mut last = hub;
        for step in 1..=10 {
            let at = along + (1.0 - along) * f64::from(step) / 10.0;
            let [hub, point] = edge.weights([1.0 - at, at]);
            assert!(hub < last && (hub + point - 1.0).abs() < 1e-15);
            last = hub;
        }
        assert!(last < 1e-15);
    }

    #[test]
    fn loops_of_two_circles_lie_at_their_anchors() {
        // Circles of radius 1 and 2 whose centres are 5 apart: η = (25 − 1 − 4)/4.
        let edge = HubEdge { eta: 5.0, is_hub: [true, true], scale: [1.0, 2.0] };
        // M of the first is η v + v': weights of positions 5/1 and 1/2.
        let [first, second] = edge.weights([5.0 / 5.5, 0.5 / 5.5]);
        assert!((first - 1.0).abs() < 1e-15 && second.abs() < 1e-15);
        let [first, second] = edge.weights([1.0 / 3.5, 2.5 / 3.5]);
        assert!(first.abs() < 1e-15 && (second - 1.0).abs() < 1e-15);
    }
}
