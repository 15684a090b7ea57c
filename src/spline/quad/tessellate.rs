//! Triangle meshes of splines over four-sided patches: a grid on each patch, with common vertices on common sides.

use super::bezier::{BezierNet, quarters};
use super::layout::{PatchCorner, PatchLayout};
use super::places::BATCH;
use super::quintic::{QUINTIC, QuinticBasis};
use super::spline::QuadSpline;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, add, norm, normalised, scale, sub};
use crate::mesh::io::{Attributes, NumberColumn, NumberType, Soup};
use crate::mesh::union_find::UnionFind;
use crate::spline::batches::in_batches;

/// Halvings of spans in each direction before second derivatives are bounded by Bézier points: these come near the surface.
const HALVINGS: usize = 2;
/// Most vertices of a tessellation.
const MOST_VERTICES: usize = 100_000_000;

/// How finely patches are divided into triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TessellationSize {
    /// Into so many parts in each direction.
    Parts(usize),
    /// So that no point of the surface is farther than this from the point of its triangle with the same parameters.
    Chord(f64),
}

/// The vertices of a tessellation: first those of the nodes of the layout, then those inside arcs, then those inside patches.
struct VertexNumbers<'a> {
    layout: &'a PatchLayout,
    /// Per arc the number of its parts.
    parts: &'a [usize],
    /// Per node its vertex, for nodes that patches have.
    nodes: Vec<u32>,
    /// Per arc its first inner vertex, and per patch.
    arcs: Vec<u32>,
    patches: Vec<u32>,
    count: usize,
}

/// A point of a grid with its unit normal; 0 where there is none.
#[derive(Debug, Clone, Copy)]
struct PatchGridPoint {
    point: Vector,
    normal: Vector,
}

impl QuadSpline {
    /// A triangle mesh of the surface, patch after patch, counterclockwise as the patches are. It has normals of vertices (0 where the surface
    /// has none), at creases those of each side for the corners, the parameters in the patch as texture coordinates of corners, and for each
    /// face the number `patch`.
    ///
    /// # Errors
    /// [`Error::Argument`] for no parts, and for a tolerance that is not positive; [`Error::TooLarge`] for more than a hundred million
    /// vertices; [`Error::Cancelled`].
    pub fn tessellate(&self, size: TessellationSize, threads: usize, control: &Control) -> Result<Soup> {
        let layout = self.space().layout();
        let parts = self.parts_of_arcs(size)?;
        let numbers = VertexNumbers::new(layout, &parts)?;
        let all: Vec<usize> = (0..layout.patches().len()).collect();
        let grids = in_batches(&all, BATCH, threads, control, |(): &mut (), &patch| {
            control.check().map(|()| self.grid(patch, numbers.size(patch)))
        })?;
        let mut positions = vec![[0.0; 3]; numbers.count];
        let mut normals = vec![[0.0; 3]; numbers.count];
        for (patch, grid) in grids.iter().enumerate() {
            for (at, PatchGridPoint { point, normal }) in grid.iter().enumerate() {
                let vertex = numbers.vertex(patch, numbers.place(patch, at)) as usize;
                positions[vertex] = *point;
                normals[vertex] = add(normals[vertex], *normal);
            }
        }
        for normal in &mut normals {
            *normal = if norm(*normal) > 0.0 { normalised(*normal) } else { [0.0; 3] };
        }
        let is_crease = numbers.on_creases();
        let has_creases = is_crease.contains(&true);
        let (mut faces, mut uv, mut corner_normals, mut patches) = (vec![], vec![], vec![], vec![]);
        for (patch, grid) in grids.iter().enumerate() {
            let [m, n] = numbers.size(patch);
            for corners in triangles([m, n]) {
                let vertices = corners.map(|[i, j]| numbers.vertex(patch, [i, j]));
                uv.push(corners.map(|[i, j]| [i as f64 / m as f64, j as f64 / n as f64]));
                if has_creases {
                    corner_normals.push([0, 1, 2].map(|k| {
                        let ([i, j], vertex) = (corners[k], vertices[k] as usize);
                        if is_crease[vertex] { grid[i * (n + 1) + j].normal } else { normals[vertex] }
                    }));
                }
                faces.push(vertices);
                patches.push(patch as f64);
            }
        }
        let column = NumberColumn { name: "patch".into(), kind: NumberType::U32, values: patches };
        let attributes = Attributes {
            normals: Some(normals),
            corner_normals: has_creases.then_some(corner_normals),
            uv: Some(uv),
            face_numbers: vec![column],
            ..Attributes::default()
        };
        Ok(Soup { positions, faces, attributes })
    }

    /// The number of triangles of a tessellation.
    ///
    /// # Errors
    /// [`Error::Argument`] as for [`QuadSpline::tessellate`].
    pub fn tessellation_faces(&self, size: TessellationSize) -> Result<usize> {
        let parts = self.parts_of_arcs(size)?;
        let patches = self.space().layout().patches();
        let of_patch =
            patches.iter().map(|[u, v, ..]| parts[u.arc as usize].saturating_mul(parts[v.arc as usize]));
        Ok(of_patch.fold(0, usize::saturating_add).saturating_mul(2))
    }

    /// The points at i / m, j / n of a patch, at i × (n + 1) + j.
    fn grid(&self, patch: usize, [m, n]: [usize; 2]) -> Vec<PatchGridPoint> {
        let [p, q] = self.space().patch_spans(patch);
        let along = |spans: usize, parts: usize| -> Vec<QuinticBasis> {
            (0..=parts).map(|k| QuinticBasis::at(spans, k as f64 / parts as f64)).collect()
        };
        let along_v = along(q, n);
        let mut grid = Vec::with_capacity((m + 1) * (n + 1));
        for u in along(p, m) {
            for v in &along_v {
                let at = self.combined(patch, &u, v);
                grid.push(PatchGridPoint { point: at.point, normal: at.normal().unwrap_or_default() });
            }
        }
        grid
    }

    /// The number of parts of each arc: the same on opposite sides of patches.
    fn parts_of_arcs(&self, size: TessellationSize) -> Result<Vec<usize>> {
        let layout = self.space().layout();
        let n = layout.arcs().len();
        let tolerance = match size {
            TessellationSize::Parts(0) => return Err(Error::argument("parts of a side", 0, "1 or more")),
            TessellationSize::Parts(parts) => return Ok(vec![parts; n]),
            TessellationSize::Chord(tolerance) if tolerance > 0.0 => tolerance,
            TessellationSize::Chord(tolerance) => {
                return Err(Error::argument("tolerance", tolerance, "a positive number"));
            }
        };
        let mut same = UnionFind::new(n);
        for sides in layout.patches() {
            same.join(sides[0].arc, sides[2].arc);
            same.join(sides[1].arc, sides[3].arc);
        }
        let mut most = vec![1.0f64; n];
        for (patch, sides) in layout.patches().iter().enumerate() {
            // A triangle with legs h and k along u and v is at most h²|F_uu|/8 + hk|F_uv|/4 + k²|F_vv|/8 from the surface.
            let [uu, uv, vv] = self.second_derivative_bounds(patch);
            for (side, bend) in [(0, uu.max(uv)), (1, vv.max(uv))] {
                let strip = same.root(sides[side].arc) as usize;
                most[strip] = most[strip].max((bend / (2.0 * tolerance)).sqrt().ceil());
            }
        }
        Ok((0..n as u32).map(|arc| most[same.root(arc) as usize].min(1e9) as usize).collect())
    }

    /// Upper bounds of the second derivatives uu, uv, vv of a patch, by differences of the Bézier points of parts of its spans.
    fn second_derivative_bounds(&self, patch: usize) -> [f64; 3] {
        let parts = self.space().patch_spans(patch).map(|n| (n << HALVINGS) as f64);
        let mut most = [0.0f64; 3];
        for net in self.bezier_nets(patch) {
            let mut nets = vec![net];
            for _ in 0..HALVINGS {
                nets = nets.iter().flat_map(|net| quarters(net).into_iter().flatten()).collect();
            }
            for found in nets.iter().map(second_differences) {
                (0..3).for_each(|k| most[k] = most[k].max(found[k]));
            }
        }
        let degree = QUINTIC as f64;
        [
            most[0] * degree * (degree - 1.0) * parts[0] * parts[0],
            most[1] * degree * degree * parts[0] * parts[1],
            most[2] * degree * (degree - 1.0) * parts[1] * parts[1],
        ]
    }
}

/// The largest second differences of Bézier points along u, along both, and along v.
fn second_differences(net: &BezierNet) -> [f64; 3] {
    let second = |[a, b, c]: [Vector; 3]| norm(add(sub(a, scale(2.0, b)), c));
    let mut most = [0.0f64; 3];
    for (a, b) in (0..=QUINTIC).flat_map(|a| (0..=QUINTIC).map(move |b| (a, b))) {
        if a + 2 <= QUINTIC {
            most[0] = most[0].max(second([net[a][b], net[a + 1][b], net[a + 2][b]]));
        }
        if b + 2 <= QUINTIC {
            most[2] = most[2].max(second([net[a][b], net[a][b + 1], net[a][b + 2]]));
        }
        if a < QUINTIC && b < QUINTIC {
            let [here, there] = [a, a + 1].map(|a| sub(net[a][b + 1], net[a][b]));
            most[1] = most[1].max(norm(sub(there, here)));
        }
    }
    most
}

impl<'a> VertexNumbers<'a> {
    fn new(layout: &'a PatchLayout, parts: &'a [usize]) -> Result<VertexNumbers<'a>> {
        let mut numbers = VertexNumbers {
            layout,
            parts,
            nodes: vec![u32::MAX; layout.n_nodes()],
            arcs: Vec::new(),
            patches: Vec::new(),
            count: 0,
        };
        for corner in layout.corners() {
            let node = layout.node(corner) as usize;
            if numbers.nodes[node] == u32::MAX {
                numbers.nodes[node] = numbers.take(1)?;
            }
        }
        for &parts in parts {
            let first = numbers.take(parts - 1)?;
            numbers.arcs.push(first);
        }
        for patch in 0..layout.patches().len() {
            let [m, n] = numbers.size(patch);
            let first = numbers.take((m - 1).saturating_mul(n - 1))?;
            numbers.patches.push(first);
        }
        Ok(numbers)
    }

    /// The first of `n` new vertices.
    fn take(&mut self, n: usize) -> Result<u32> {
        let first = self.count;
        self.count = first.saturating_add(n);
        if self.count > MOST_VERTICES {
            return Err(Error::TooLarge { what: "vertices of the tessellation", count: self.count });
        }
        Ok(first as u32)
    }

    /// The parts of a patch along u and v.
    fn size(&self, patch: usize) -> [usize; 2] {
        [0, 1].map(|side| self.parts[self.layout.patches()[patch][side].arc as usize])
    }

    /// i and j of a point of a patch's grid.
    fn place(&self, patch: usize, at: usize) -> [usize; 2] {
        let [_, n] = self.size(patch);
        [at / (n + 1), at % (n + 1)]
    }

    /// The vertex at i, j of a patch.
    fn vertex(&self, patch: usize, [i, j]: [usize; 2]) -> u32 {
        let [m, n] = self.size(patch);
        // The side on which it lies, and how many parts from that side's start.
        let on_side = match (i, j) {
            (_, 0) if i < m => (0, i),
            (_, _) if i == m && j < n => (1, j),
            (_, _) if j == n && i > 0 => (2, m - i),
            (0, _) => (3, n - j),
            _ => return self.patches[patch] + ((i - 1) * (n - 1) + j - 1) as u32,
        };
        let (corner, along) = on_side;
        if along == 0 {
            return self.nodes[self.layout.node(PatchCorner { patch, corner }) as usize];
        }
        let side = self.layout.patches()[patch][corner];
        let arc = side.arc as usize;
        let from_start = if side.reversed { self.parts[arc] - along } else { along };
        self.arcs[arc] + from_start as u32 - 1
    }

    /// Per vertex true on creases inside the surface.
    fn on_creases(&self) -> Vec<bool> {
        let mut is_crease = vec![false; self.count];
        for (k, arc) in self.layout.arcs().iter().enumerate() {
            if arc.is_crease && !self.layout.beside(k).contains(&None) {
                arc.ends.iter().for_each(|&node| is_crease[self.nodes[node as usize] as usize] = true);
                let first = self.arcs[k] as usize;
                is_crease[first..first + self.parts[k] - 1].fill(true);
            }
        }
        is_crease
    }
}

/// The triangles of a grid of m × n cells, two for each.
fn triangles([m, n]: [usize; 2]) -> impl Iterator<Item = [[usize; 2]; 3]> {
    let cells = (0..m).flat_map(move |i| (0..n).map(move |j| [i, j]));
    cells.flat_map(|[i, j]| {
        let [a, b, c, d] = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
        [[a, b, c], [a, c, d]]
    })
}
