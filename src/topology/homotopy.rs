//! Canonical homotopy bases, and the group elements of edge paths.
//!
//! ```
//! use ricci::topology::homotopy_basis;
//! use ricci::{Control, mesh::shapes};
//! let (mesh, lengths) = shapes::flat_torus([0.0, 1.0], 4, 4)?.build()?;
//! let basis = homotopy_basis(&mesh, &lengths, None, &Control::new())?;
//! let both = [&basis.loops[0][..], &basis.loops[1]].concat();
//! assert_eq!(basis.group.text(&basis.path_word(&mesh, &both)?), "a1 b1");
//! # Ok::<(), ricci::Error>(())
//! ```

use super::brahana::{NormalForm, best_starts, normal_form};
use super::group::SurfaceGroup;
use super::handle::{HandleLoops, LoopPair};
use super::places::PlaceWords;
use super::polygon::OpenedPolygon;
use super::reduction::Reduction;
use super::rooted::RootedTree;
use super::shorten::{path_length, shorten};
use super::spanning::Forest;
use super::word::{Letter, Word};
use super::{check_connected, check_lengths, check_path, check_vertex, corners_along};
use crate::archive::stored;
use crate::control::Control;
use crate::error::{Result, check_size};
use crate::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, PerHalfedge, VertexId};

/// Generators of the fundamental group of a surface as loops through one base vertex p, with the one relator
///
/// ```text
///     a1 b1 a1⁻¹ b1⁻¹ … ag bg ag⁻¹ bg⁻¹ c1 … cb = 1,
/// ```
///
/// and the data that name points of the universal cover. Letters compose left to right, as paths do. `b_i` crosses `a_i` once, from right
/// to left (intersection number +1); `c_j` is freely homotopic to a boundary loop that has the surface on its left.
///
/// **Lifts.** One lift p̃ of the base is chosen. A group element γ acts on the cover by the deck transformation that maps p̃ to the end
/// of the lift of γ that starts there. Every vertex v has a tree path from p, and ṽ is the end of its lift from p̃; the lifts of v are `γ
/// ṽ`, one for each γ.
///
/// **Polygon.** The surface opened along the tree and the edges left over is a disk. Its lift D with a corner at p̃ is a fundamental
/// domain; γ D are its copies. The corner of D at the origin of h is the lift `corner_word(h) ṽ`.
#[derive(Debug, Clone)]
pub struct HomotopyBasis {
    /// The base vertex p.
    pub base: VertexId,
    /// The group, with its names and relator.
    pub group: SurfaceGroup,
    /// For each generator (a1, b1, …, ag, bg, c1, …, cb) its loop: half-edges that start and end at the base.
    pub loops: Vec<Vec<HalfedgeId>>,
    /// For each c_j the half-edge of a face on its boundary loop that is not in the tree: c_j runs along the tree to its tip, once around
    /// the boundary with the surface on the left, and back.
    pub rims: Vec<HalfedgeId>,
    tree: Forest,
    place: PerHalfedge<u32>,
    places: PlaceWords,
}
stored!(sections HomotopyBasis { base, group, loops, rims, tree, place, places });

/// The polygon's word is read from several places, whose loops are pulled straight and compared, until these loops have had this number
/// of edges in total per edge of the mesh. This bounds the time.
const WORK_PER_EDGE: usize = 8;

/// A canonical homotopy basis of a connected surface, with short loops.
///
/// `lengths`: finite and positive, one per edge. `base`: the base vertex; with `None` one is chosen from which the loops are short. The
/// edges that are neither in a shortest-path tree nor in a dual tree generate the group \[EW05\]; the disk's boundary word in them is
/// brought into normal form \[Bra21\], \[LPVV01\]; the loops of each handle are then changed by Dehn twists along one another (`a → a
/// b^±1`, `b → b a^±1`, which keep the commutator) and pulled straight across triangles, as long as they become shorter. O(E log E) for a
/// fixed genus; O(g³) at worst for the words.
///
/// # Errors
///
/// [`crate::Error::EdgeLength`], [`crate::Error::Size`]; [`crate::Error::Argument`] for a base that is no vertex;
/// [`crate::Error::Layout`] for an empty surface or one of several components; [`crate::Error::Cancelled`].
pub fn homotopy_basis(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    base: Option<VertexId>,
    control: &Control,
) -> Result<HomotopyBasis> {
    control.check()?;
    check_lengths(mesh, lengths)?;
    check_connected(mesh, "take a homotopy basis of")?;
    let rooted = match base {
        Some(base) => {
            check_vertex(mesh, base)?;
            RootedTree::new(mesh, lengths, base, control)?
        }
        None => RootedTree::central(mesh, lengths, control)?,
    };
    let polygon = OpenedPolygon::new(mesh, rooted);
    let (NormalForm { ends, prefixes, .. }, pairs) = shortest_handles(mesh, lengths, &polygon, control)?;
    let mut loops = Vec::with_capacity(2 * pairs.len() + ends.len());
    let mut products = Vec::with_capacity(pairs.len());
    for (i, pair) in pairs.into_iter().enumerate() {
        let mut handle = HandleLoops::new(pair);
        handle.twist(mesh, lengths, control)?;
        products.push(handle.prefixes(i));
        loops.extend(handle.loops);
    }
    for &end in &ends {
        let path = polygon.letter_loop(mesh, end);
        loops.push(shorten(mesh, lengths, path.into_iter(), control)?);
    }
    Ok(HomotopyBasis {
        base: polygon.rooted.root,
        group: SurfaceGroup { genus: products.len(), boundaries: ends.len() },
        loops,
        rims: ends.iter().map(|end| polygon.halfedges[end.index()]).collect(),
        tree: polygon.rooted.tree,
        place: polygon.place,
        places: PlaceWords { prefixes, products },
    })
}

/// The normal form whose handles have the shortest loops after these are pulled straight, among those of the polygon's word read from
/// several places; with these loops.
fn shortest_handles(
    mesh: &Mesh,
    lengths: &PerEdge<f64>,
    polygon: &OpenedPolygon,
    control: &Control,
) -> Result<(NormalForm, Vec<LoopPair>)> {
    let cost: Vec<_> =
        polygon.halfedges.iter().map(|h| polygon.rooted.tree.arc(mesh, lengths, h.edge())).collect();
    let path = |word: &Word| -> Vec<HalfedgeId> {
        word.letters().iter().flat_map(|&letter| polygon.letter_loop(mesh, letter)).collect()
    };
    let read_from = |start: usize| -> Result<_> {
        let form = normal_form(&polygon.letters, &cost, start);
        let (mut pairs, mut length, mut work) = (Vec::with_capacity(form.handles.len()), 0.0, 0);
        for handle in &form.handles {
            let paths = [path(&handle.a), path(&handle.b)];
            work += paths[0].len() + paths[1].len();
            let [a, b] = paths.map(|path| shorten(mesh, lengths, path.into_iter(), control));
            let pair = [a?, b?];
            length += path_length(lengths, &pair[0]) + path_length(lengths, &pair[1]);
            pairs.push(pair);
        }
        Ok((length, work, (form, pairs)))
    };
    let mut starts = best_starts(&polygon.letters, &cost).into_iter();
    let (mut least, mut done, mut best) = read_from(starts.next().unwrap_or(0))?;
    while let Some(start) = starts.next().filter(|_| done <= WORK_PER_EDGE * mesh.n_edges()) {
        let (length, work, next) = read_from(start)?;
        done += work;
        if length < least {
            (least, best) = (length, next);
        }
    }
    Ok(best)
}

impl HomotopyBasis {
    /// Total length of the loops.
    pub fn length(&self, lengths: &PerEdge<f64>) -> f64 {
        self.loops.iter().map(|path| path_length(lengths, path)).sum()
    }

    /// The tree path from the base to `v`; its lift from p̃ ends at ṽ.
    ///
    /// # Errors
    ///
    /// [`crate::Error::Argument`] for a vertex that does not exist.
    pub fn tree_path(&self, mesh: &Mesh, v: VertexId) -> Result<Vec<HalfedgeId>> {
        self.check_fits(mesh)?;
        check_vertex(mesh, v)?;
        Ok(self.tree.path_down(mesh, v))
    }

    /// The lift of a face's corner: the corner at the origin v of `h`, a half-edge of a face, is the vertex `γ ṽ` of the polygon D, where
    /// γ is this word, of at most 8g + 2b letters (more where a handle has been twisted).
    pub fn corner_word(&self, h: HalfedgeId) -> Word {
        // The first place has a corner at the base.
        self.places.between(0, self.place[h]).collect()
    }

    /// The element of a half-edge from u to v, that is of the loop along the tree to u, along `h`, and back along the tree. The lift of
    /// `h` that starts at ũ ends at `γ ṽ`. Freely reduced; empty on the tree.
    pub fn halfedge_word(&self, mesh: &Mesh, h: HalfedgeId) -> Word {
        self.halfedge_letters(mesh, h).collect()
    }

    fn halfedge_letters(&self, mesh: &Mesh, h: HalfedgeId) -> impl Iterator<Item = Letter> + '_ {
        // The two corners of one face are lifted together.
        let [from, to] = corners_along(mesh, h);
        self.places.between(self.place[from], self.place[to])
    }

    /// The element of an edge path from u to v, that is of the loop along the tree to u, along the path, and back along the tree; for a
    /// loop at the base, of the loop itself. Reduced in the group ([`SurfaceGroup::reduce`]). The lift of the path that starts at ũ ends
    /// at `γ ṽ`.
    ///
    /// # Errors
    ///
    /// [`crate::Error::Argument`] for half-edges that do not follow each other.
    pub fn path_word(&self, mesh: &Mesh, path: &[HalfedgeId]) -> Result<Word> {
        self.check_fits(mesh)?;
        check_path(mesh, path)?;
        let mut reduction = Reduction::new(self.group);
        path.iter().for_each(|&h| self.advance(mesh, &mut reduction, h));
        Ok(reduction.word())
    }

    /// The copy of the polygon D across a half-edge of a face: crossing `h` out of the copy γ D leads to `γ · transition(h) D`. Freely
    /// reduced; empty where the polygon is not cut, and outside the surface.
    pub fn transition(&self, mesh: &Mesh, h: HalfedgeId) -> Word {
        if mesh.is_boundary_edge(h.edge()) {
            return Word::identity();
        }
        // The lift of h's origin is a corner of both copies.
        let across = mesh.next(h.twin());
        if self.place[h] == self.place[across] {
            Word::identity()
        } else {
            self.corner_word(h).times(&self.corner_word(across).inverse())
        }
    }

    /// The interior edges along which the polygon D is cut: those with a non-trivial [`HomotopyBasis::transition`]. They open the surface
    /// into a disk (a closed surface of genus 0 has none).
    pub fn cut(&self, mesh: &Mesh) -> PerEdge<bool> {
        PerEdge::from_fn(mesh.n_edges(), |e: EdgeId| {
            let h = e.halfedge();
            !mesh.is_boundary_edge(e) && self.place[h] != self.place[mesh.next(h.twin())]
        })
    }

    /// Checks that the mesh has as many elements as that of the basis.
    pub(super) fn check_fits(&self, mesh: &Mesh) -> Result<()> {
        check_size("half-edges of the basis", self.place.len(), mesh.n_halfedges())?;
        check_size("vertices of the basis", self.tree.parent.len(), mesh.n_vertices())
    }

    /// Multiplies a product by the element of `h` from the right.
    pub(super) fn advance(&self, mesh: &Mesh, reduction: &mut Reduction, h: HalfedgeId) {
        reduction.extend(self.halfedge_letters(mesh, h));
    }
}
