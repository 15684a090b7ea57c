//! Maps to the plane as a descent moves them.

use super::descent::MovingMap;
use super::descent_matrix::DescentMatrix;
use super::energy::EnergyShares;
use super::rest_triangle::RestTriangle;
use super::step_bound::time_to_flat;
use super::terms::Terms;
use super::upright::is_upright;
use crate::control::Control;
use crate::error::Result;
use crate::parallel;

/// Share of the way to the first triangle without area that a step takes at most.
const OF_THE_WAY: f64 = 0.9;

/// What the energy of a map to the plane is made of.
pub(super) struct PlaneMoves<'a> {
    pub corners: &'a [[u32; 3]],
    pub rest: &'a [RestTriangle],
    pub shares: EnergyShares,
    pub terms: Terms,
}

impl PlaneMoves<'_> {
    fn at(&self, f: usize, points: &[[f64; 2]]) -> [[f64; 2]; 3] {
        self.corners[f].map(|v| points[v as usize])
    }

    /// The least time at which a triangle has lost its area along a direction.
    fn time_to_flat(&self, points: &[[f64; 2]], direction: &[[f64; 2]]) -> f64 {
        let mut times = vec![0.0; self.corners.len()];
        parallel::fill(&mut times, |f| time_to_flat(self.at(f, points), self.at(f, direction)));
        times.into_iter().fold(f64::INFINITY, f64::min)
    }
}

impl MovingMap for PlaneMoves<'_> {
    type Place = [f64; 2];

    /// Summed in the order of the triangles and of the terms.
    fn merit(&self, points: &[[f64; 2]]) -> f64 {
        let mut parts = vec![0.0; self.rest.len()];
        parallel::fill(&mut parts, |f| self.rest[f].energy(&self.shares, self.at(f, points)));
        let triangles: f64 = parts.into_iter().sum();
        triangles + self.terms.energy(points) + self.terms.conditions_value(points)
    }

    fn conditions_value(&self, points: &[[f64; 2]]) -> f64 {
        self.terms.conditions_value(points)
    }

    fn look_at(
        &mut self,
        points: &[[f64; 2]],
        system: &mut DescentMatrix<'_>,
        control: &Control,
    ) -> Result<()> {
        self.terms.find_contacts(points);
        system.hold(self.terms.contact_pairs(), control)
    }

    fn assemble(&self, system: &mut DescentMatrix<'_>, points: &[[f64; 2]], clamped: bool) {
        system.assemble(|f| self.rest[f].model(&self.shares, self.at(f, points), clamped));
        let stiffness = self.terms.stiffness();
        system.add_terms(self.terms.list(), |term| term.model(points, stiffness, clamped));
    }

    fn bound(&self, points: &[[f64; 2]], direction: &[[f64; 2]]) -> f64 {
        let share = f64::min(1.0, OF_THE_WAY * self.time_to_flat(points, direction));
        share.min(OF_THE_WAY * self.terms.time_to_meet(points, direction, share))
    }

    fn moved(&self, [x, y]: [f64; 2], by: [f64; 2]) -> [f64; 2] {
        [x + by[0], y + by[1]]
    }

    fn is_map(&self, points: &[[f64; 2]]) -> bool {
        is_upright(self.corners, points) && self.terms.allow(points)
    }
}
