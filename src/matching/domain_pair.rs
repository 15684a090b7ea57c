//! Both surfaces in one domain: the result of every strategy.

use super::balance::BalanceReport;
use super::cover::{PlacedMesh, WalkSeed};

/// Two triangulations in the universal cover of one surface.
pub(super) struct DomainPair {
    pub source: PlacedMesh,
    pub target: PlacedMesh,
    /// The places where the search for the source's vertices in the target starts, and for the target's in the source.
    pub seeds: [WalkSeed; 2],
    pub reports: [BalanceReport; 2],
    /// Steps of the flows to the two canonical metrics.
    pub flow_iterations: [usize; 2],
    /// Number of homotopy classes whose maps were compared.
    pub markings: usize,
}

impl DomainPair {
    /// The energy of the source in the target's domain over that of the target: near 1 for a map without twists between similar surfaces.
    pub fn twist(&self) -> f64 {
        self.reports[0].energy / self.reports[1].energy.max(f64::MIN_POSITIVE)
    }
}
