//! The charts of a structure as lists, and the points of the surface in the charts.

use crate::arrays::{CallerBuffer, array, check_buffer, copy_each, copy_out, copy_rows};
use crate::choice::choices;
use crate::failure::Outcome;
use crate::guard::{self, output};
use crate::status::ricci_status;
use crate::structure::ricci_structure;
use ricci::mesh::FaceId;
use ricci::structure::{Atlas, Chart, FaceLift};

choices!(enum ChartRows, ROWS = "which", [
    RICCI_CHART_FACES => Faces,
    RICCI_CHART_CORNERS => Corners,
    RICCI_CHART_VERTICES => Vertices,
    RICCI_TRANSITION_PAIRS => Pairs,
]);

impl ChartRows {
    fn of(self, atlas: &Atlas) -> Vec<Vec<u32>> {
        let faces = |chart: &Chart| chart.faces.iter().map(|f| f.0).collect();
        let vertices = |chart: &Chart| chart.vertices.iter().map(|v| v.0).collect();
        match self {
            ChartRows::Faces => atlas.charts.iter().map(faces).collect(),
            ChartRows::Vertices => atlas.charts.iter().map(vertices).collect(),
            ChartRows::Corners => atlas.charts.iter().map(|chart| chart.corners.concat()).collect(),
            ChartRows::Pairs => atlas.transitions.iter().map(|t| t.pairs.concat()).collect(),
        }
    }
}

choices!(enum StructureList, LISTS = "which", [
    RICCI_STRUCTURE_SINGULAR => Singular,
    RICCI_STRUCTURE_EXCLUDED => Excluded,
    RICCI_STRUCTURE_FOLDED => Folded,
    RICCI_STRUCTURE_ZEROS => Zeros,
    RICCI_STRUCTURE_TRIANGLES => Triangles,
]);

impl StructureList {
    fn of(self, atlas: &Atlas) -> Vec<u32> {
        match self {
            StructureList::Singular => atlas.singular_vertices.iter().map(|v| v.0).collect(),
            StructureList::Excluded => atlas.excluded.iter().map(|f| f.0).collect(),
            StructureList::Folded => atlas.folded.clone(),
            StructureList::Zeros => {
                atlas.zeros.iter().flat_map(|z| [z.vertex.0, z.multiplicity as u32]).collect()
            }
            StructureList::Triangles => atlas.mesh.triangles().concat(),
        }
    }
}

fn lift(what: &str, place: *const u32) -> Outcome<FaceLift> {
    let numbers: Vec<u32> = array(what, place, 2)?;
    Ok(FaceLift { chart: numbers[0], face: numbers[1] })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_structure_rows(
    structure: *const ricci_structure,
    which: u32,
    entries: *mut u32,
    capacity: usize,
    starts: *mut usize,
    starts_capacity: usize,
) -> ricci_status {
    guard::with(structure, |ricci_structure { atlas }| {
        copy_rows(
            "entries",
            ROWS.choose(which)?.of(atlas),
            CallerBuffer(entries, capacity),
            CallerBuffer(starts, starts_capacity),
        )
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_structure_list(
    structure: *const ricci_structure,
    which: u32,
    numbers: *mut u32,
    capacity: usize,
) -> ricci_status {
    guard::with(structure, |ricci_structure { atlas }| {
        copy_out("numbers", &LISTS.choose(which)?.of(atlas), numbers, capacity)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_structure_places(
    structure: *const ricci_structure,
    face: u32,
    weights: *const f64,
    lifts: *mut u32,
    coordinates: *mut f64,
    capacity: usize,
    n_places: *mut usize,
) -> ricci_status {
    guard::with(structure, |ricci_structure { atlas }| {
        let weights: Vec<[f64; 3]> = array("weights", weights.cast(), 1)?;
        let count = output("the place for the number of places", n_places)?;
        let found = atlas.places(FaceId(face), weights[0])?;
        if capacity > 0 || !lifts.is_null() || !coordinates.is_null() {
            check_buffer("places", found.len(), coordinates, capacity)?;
            let own: Vec<[u32; 2]> = found.iter().map(|p| [p.lift.chart, p.lift.face]).collect();
            let points: Vec<[f64; 2]> = found.iter().map(|p| p.coordinates).collect();
            copy_out("lifts", &own, lifts, capacity.saturating_mul(2))?;
            copy_out("coordinates", &points, coordinates, capacity.saturating_mul(2))?;
        }
        count.set(found.len());
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_structure_carry(
    structure: *const ricci_structure,
    from: *const u32,
    to: *const u32,
    points: *const f64,
    n: usize,
    moved: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(structure, |ricci_structure { atlas }| {
        let element = atlas.between(lift("from", from)?, lift("to", to)?)?;
        let points: Vec<[f64; 2]> = array("points", points.cast(), n)?;
        copy_each("moved", n, points.into_iter().map(|p| element.apply(p)), moved, capacity)
    })
}
