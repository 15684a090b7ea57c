//! The measurements as the page docs/results/bench-forms.md.

use crate::Row;
use crate::common::machine::{machine, put};
use crate::disks::{Disk, METHODS};

/// The page; `peers` says what they are, or why there are none.
pub fn page(
    forms: &[Row],
    disks: &[Disk],
    peers: Result<String, String>,
    load: [Option<String>; 2],
) -> String {
    let mut page = String::from(
        "# Bench of harmonic forms and maps

Made by `cargo bench --bench forms > docs/results/bench-forms.md`. Medians over the rounds, in seconds.

## Forms

All 2g harmonic forms of generated surfaces with noise, with their period matrix. Triangulation: intrinsic Delaunay, with its weights.
Topology: loops and closed forms. Forms: topology, matrix, factorisation and solves together. Yardstick: assembly, one analysis, one
factorisation of the same matrix and 2g solves, and nothing else. Bytes: the peak of the heap during all of it, the surface apart, over
g V.

| genus | vertices | triangulation | topology | assemble | analyse | factor | solve | forms | forms / yardstick | period matrix | µs of solve / g V | bytes / g V | MB |
|---|---|---|---|---|---|---|---|---|---|---|---|---|---|
",
    );
    for row in forms {
        let s = row.phases;
        put(&mut page, format_args!("| {} | {} |", row.genus, row.vertices));
        for seconds in [row.domain, s.topology, s.assemble, s.analyse, s.factor, s.solve, row.forms] {
            put(&mut page, format_args!(" {seconds:.3} |"));
        }
        let work = (row.genus * row.vertices) as f64;
        let (ratio, solve) = (row.forms / row.yardstick, s.solve / work * 1e6);
        put(&mut page, format_args!(" {ratio:.2} | {:.3} | {solve:.2} |", row.periods));
        put(&mut page, format_args!(" {:.0} | {:.0} |\n", row.bytes as f64 / work, row.bytes as f64 / 1e6));
    }
    page += "
## Disks

The harmonic map onto the round disk with the boundary by its length, beside CGAL's Tutte and discrete conformal maps onto the same disk
(solved as CGAL does by default, and by Eigen's sparse LU) and its least squares conformal map (LSCM) with two vertices held; the mesh in
memory, to the images of its vertices. Ours: the intrinsic Delaunay triangulation, then the map. Turned: triangles that the map turns over, ours of the
Delaunay triangulation, theirs of the mesh. Same map: largest distance of CGAL's discrete conformal images (LU) from ours on the mesh's own triangulation, in a disk of radius 1.

| disk | vertices | triangulation | map | together | turned |";
    let peered = disks.iter().any(|disk| !disk.peers.is_empty());
    if peered {
        METHODS.iter().for_each(|method| put(&mut page, format_args!(" {method} | turned |")));
        page += " fastest / ours | same map |";
    }
    put(
        &mut page,
        format_args!("\n|{}\n", "---|".repeat(6 + if peered { 2 * METHODS.len() + 2 } else { 0 })),
    );
    for disk in disks {
        let [prepare, solve] = disk.ours;
        let ours = prepare + solve;
        put(&mut page, format_args!("| {} | {} | {prepare:.3} | {solve:.3} |", disk.name, disk.vertices));
        put(&mut page, format_args!(" {ours:.3} | {} |", disk.flipped));
        disk.peers.iter().for_each(|(took, turned)| put(&mut page, format_args!(" {took:.3} | {turned} |")));
        if let Some(difference) = disk.difference {
            let fastest = disk.peers.iter().fold(f64::INFINITY, |least, x| least.min(x.0));
            put(&mut page, format_args!(" {:.1} | {difference:.1e} |", fastest / ours));
        }
        page.push('\n');
    }
    machine(&mut page, Some(peers), load);
    page.truncate(page.trim_end().len());
    page
}
