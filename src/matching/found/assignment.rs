//! Pairs of extremities of two surfaces that may correspond: the distances between them, and their descriptors, have to agree.

use super::extremities::Extremity;

/// Number of assignments that are kept.
const KEPT: usize = 16;
/// Cost of an extremity without partner: more than two corresponding ones of animals in other poses differ by.
const SKIPPED: f64 = 0.12;
/// Fewest pairs of an assignment: distances to three points tell the points of a surface apart but for reflections.
const FEWEST: usize = 3;

/// The assignments of least cost, each as pairs of places in both lists.
pub(super) fn assignments(source: &[Extremity], target: &[Extremity]) -> Vec<Vec<[usize; 2]>> {
    let between = |all: &[Extremity]| -> Vec<Vec<f64>> {
        all.iter().map(|a| all.iter().map(|b| a.distance[b.vertex]).collect()).collect()
    };
    let unlike = |a: &Extremity, b: &Extremity| {
        let off = a.descriptor.iter().zip(&b.descriptor).map(|(a, b)| (a - b).abs());
        off.sum::<f64>() / a.descriptor.len().max(1) as f64
    };
    let mut search = AssignmentSearch {
        distances: [between(source), between(target)],
        unlike: source.iter().map(|a| target.iter().map(|b| unlike(a, b)).collect()).collect(),
        chosen: Vec::new(),
        best: Vec::new(),
    };
    search.from(0, 0.0);
    search.best.into_iter().map(|(_, pairs)| pairs).collect()
}

/// A search of all assignments, one extremity of the source after the other, that leaves those which cost too much already.
struct AssignmentSearch {
    distances: [Vec<Vec<f64>>; 2],
    unlike: Vec<Vec<f64>>,
    chosen: Vec<[usize; 2]>,
    best: Vec<(f64, Vec<[usize; 2]>)>,
}

impl AssignmentSearch {
    fn from(&mut self, i: usize, cost: f64) {
        if self.best.len() >= KEPT && self.best.last().is_some_and(|(most, _)| cost >= *most) {
            return;
        }
        if i == self.unlike.len() {
            if self.chosen.len() >= FEWEST {
                let place = self.best.partition_point(|(other, _)| *other <= cost);
                self.best.insert(place, (cost, self.chosen.clone()));
                self.best.truncate(KEPT);
            }
            return;
        }
        let others = (self.unlike.len() - 1).max(1) as f64;
        for j in 0..self.unlike[i].len() {
            if self.chosen.iter().any(|pair| pair[1] == j) {
                continue;
            }
            let off =
                self.chosen.iter().map(|&[k, l]| (self.distances[0][i][k] - self.distances[1][j][l]).abs());
            let more = self.unlike[i][j] + off.sum::<f64>() / others;
            self.chosen.push([i, j]);
            self.from(i + 1, cost + more);
            self.chosen.pop();
        }
        self.from(i + 1, cost + SKIPPED);
    }
}
