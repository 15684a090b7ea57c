//! Diagnosis of triangles that are glued consistently along numbered edges.

use super::{Defect, Diagnosis, genus, several_components};
use crate::mesh::incidence::{boundary_loops, components};
use crate::mesh::union_find::UnionFind;

/// Diagnoses faces whose side k is the half-edge `sides[f][k]`; half-edge h starts at `origin[h]`, its twin is `h ^ 1`, and no half-edge
/// is in two faces.
pub(in crate::mesh) fn diagnose_gluing(
    n_vertices: usize,
    faces: &[[u32; 3]],
    origin: &[u32],
    sides: &[[u32; 3]],
) -> Diagnosis {
    let mut defects = Vec::new();
    if faces.is_empty() {
        defects.push(Defect::Empty { collapsed: 0 });
    }
    // Half-edges that leave a vertex are in one fan if one comes from one to the other around the vertex: from h to the twin of the half-edge
    // before it in its face.
    let mut fans = UnionFind::new(origin.len());
    let mut has_face = vec![false; origin.len()];
    for s in sides {
        for k in 0..3 {
            fans.join(s[k], s[(k + 2) % 3] ^ 1);
            has_face[s[k] as usize] = true;
        }
    }
    let mut sheets = vec![0u32; n_vertices];
    for h in 0..origin.len() as u32 {
        sheets[origin[h as usize] as usize] += u32::from(fans.root(h) == h);
    }
    let vertices = || (0u32..).zip(&sheets);
    let several = vertices().filter(|(_, sheets)| **sheets > 1);
    defects.extend(several.map(|(vertex, &sheets)| Defect::NonManifoldVertex { vertex, sheets }));
    let isolated = vertices().filter(|(_, sheets)| **sheets == 0);
    defects.extend(isolated.map(|(vertex, _)| Defect::IsolatedVertex { vertex }));
    let components = several_components(components(n_vertices, (0u32..).zip(faces)), &mut defects);
    let edges = origin.len() / 2;
    let used = sheets.iter().filter(|&&sheets| sheets > 0).count();
    let euler = used as i64 - edges as i64 + faces.len() as i64;
    let boundary = (0..origin.len()).filter(|&h| !has_face[h]).map(|h| [origin[h], origin[h ^ 1]]);
    let boundary_loops = boundary_loops(n_vertices, boundary);
    let genus = if defects.is_empty() { genus(euler, boundary_loops) } else { None };
    Diagnosis {
        vertices: n_vertices,
        edges,
        faces: faces.len(),
        components,
        euler,
        boundary_loops,
        genus,
        defects,
        hints: Vec::new(),
    }
}
