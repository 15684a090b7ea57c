//! Results that hold everything that they came from, and are their own records.

use crate::archive::{ArchiveReader, ArchiveWriter, Kept, Stored};
use crate::canonical::{CircleDomain, Uniformization};
use crate::error::Result;
use crate::structure::Atlas;

impl Stored for Uniformization {
    const LEAST: usize = 1;

    fn write(&self, to: &mut ArchiveWriter) {
        match self {
            Uniformization::Sphere(sphere) => to.section("sphere", sphere),
            Uniformization::FlowedSphere(sphere) => to.section("flowed sphere", sphere),
            Uniformization::Quotient(quotient) => to.section("quotient", quotient),
        }
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        match from.next_section()? {
            b"sphere" => from.section("sphere").map(Uniformization::Sphere),
            b"flowed sphere" => from.section("flowed sphere").map(Uniformization::FlowedSphere),
            _ => from.section("quotient").map(Uniformization::Quotient),
        }
    }
}

impl Kept for Uniformization {
    const KIND: &'static str = "uniformization";
}

impl Kept for CircleDomain {
    const KIND: &'static str = "circle domain";
}

impl Kept for Atlas {
    const KIND: &'static str = "structure";
}
