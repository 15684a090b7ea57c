//! Landmarks, corners and boundary loops of both surfaces from the options: they are checked and brought into corresponding order.

use super::marked_surface::Marks;
use crate::error::{Error, Result};
use crate::mesh::{HalfedgeId, VertexId};
use crate::metric::Surface;
use crate::topology::check_vertex;

/// Landmarks, corners and loops of both surfaces in corresponding order. `order`: per loop of the source the number of the target's.
///
/// # Errors
/// [`Error::Matching`] for landmarks that are no pairs of different vertices both inside or both on corresponding loops in the same order,
/// and for loops that are no permutation; [`Error::Argument`] for a landmark that is no vertex.
pub(crate) fn marks(
    surfaces: [&Surface; 2],
    landmarks: &[[VertexId; 2]],
    order: Option<&[usize]>,
) -> Result<[Marks; 2]> {
    check_landmarks(surfaces, landmarks)?;
    let loops = [0, 1].map(|s| loops(surfaces[s]));
    let order = match order {
        None => orders(&loops, &landmarked(surfaces, landmarks, &loops)?).swap_remove(0),
        Some(order) => {
            let n = loops[0].len();
            let mut seen = vec![false; n];
            let is_permutation =
                order.len() == n && order.iter().all(|&k| k < n && !std::mem::replace(&mut seen[k], true));
            if !is_permutation {
                return Err(Error::Matching(format!(
                    "loops {order:?} (--loops) do not name each of the {n} boundary loops of the target once"
                )));
            }
            order.to_vec()
        }
    };
    let [source, target] = loops.map(|all| all.into_iter().map(|(around, _)| around).collect::<Vec<_>>());
    let target = order.into_iter().map(|k| target[k].clone()).collect();
    let on_boundary = |s: usize, pair: &[VertexId; 2]| surfaces[s].mesh().is_boundary_vertex(pair[s]);
    let of = |s: usize, outside: bool| -> Vec<VertexId> {
        landmarks.iter().filter(|pair| on_boundary(s, pair) == outside).map(|pair| pair[s]).collect()
    };
    let marks = |s: usize, loops| Marks { landmarks: of(s, false), loops, corners: of(s, true) };
    let marks = [marks(0, source), marks(1, target)];
    check_corners(surfaces, &marks)?;
    Ok(marks)
}

fn check_landmarks(surfaces: [&Surface; 2], landmarks: &[[VertexId; 2]]) -> Result<()> {
    for (k, pair) in landmarks.iter().enumerate() {
        for (s, name) in ["source", "target"].into_iter().enumerate() {
            let v = pair[s];
            check_vertex(surfaces[s].mesh(), v)?;
            if let Some(j) = landmarks[..k].iter().position(|other| other[s] == v) {
                return Err(Error::Matching(format!(
                    "landmarks {j} and {k} conflict: both are vertex {v} of the {name}"
                )));
            }
        }
        let outside = [0, 1].map(|s| surfaces[s].mesh().is_boundary_vertex(pair[s]));
        if outside[0] != outside[1] {
            let [on, inside] = if outside[0] { ["source", "target"] } else { ["target", "source"] };
            return Err(Error::Matching(format!(
                "landmark {k} lies on the boundary of the {on} and inside the {inside}"
            )));
        }
    }
    Ok(())
}

/// Checks that corners lie on corresponding loops in the same order.
fn check_corners(surfaces: [&Surface; 2], marks: &[Marks; 2]) -> Result<()> {
    for k in 0..marks[0].loops.len() {
        let along = |s: usize| -> Vec<usize> {
            let mesh = surfaces[s].mesh();
            let number = |h: &HalfedgeId| marks[s].corners.iter().position(|&v| v == mesh.origin(*h));
            let mut found: Vec<usize> = marks[s].loops[k].iter().filter_map(number).collect();
            if let Some(least) = (0..found.len()).min_by_key(|&i| found[i]) {
                found.rotate_left(least);
            }
            found
        };
        let [first, second] = [along(0), along(1)];
        if first != second {
            let name = |numbers: &[usize]| {
                numbers.iter().map(|&n| marks[0].corners[n].to_string()).collect::<Vec<_>>().join(", ")
            };
            return Err(Error::Matching(format!(
                "landmarks on boundary loop {k} of the source conflict: around it come those at vertices {} of the source, around the loop of the \
                 target that it goes to their partners come in the order of {}: --loops K,K,… says where each loop of the source goes",
                name(&first),
                name(&second)
            )));
        }
    }
    Ok(())
}

/// The boundary loops with the surface on their left, and their lengths.
fn loops(surface: &Surface) -> Vec<MeasuredLoop> {
    let (mesh, lengths) = (surface.mesh(), surface.lengths());
    let of = |around: Vec<HalfedgeId>| {
        let length = around.iter().map(|h| lengths[h.edge()]).sum();
        (around.first().map_or(Vec::new(), |h| mesh.boundary_from(h.twin())), length)
    };
    mesh.boundary_loops().into_iter().map(of).collect()
}

/// Share of their length by which loops may differ and still count as equally long: their lengths then say nothing about which correspond.
const LIKE: f64 = 0.05;
/// Most orders of loops that are compared.
const MOST_ORDERS: usize = 6;

/// The orders of loops that landmarks and lengths leave open, each as the target's loop for each of the source's: first that in which the
/// loops without landmarks correspond by descending length, then those in which loops of equal lengths change places. If there are more
/// than [`MOST_ORDERS`], the first one alone.
///
/// # Errors
/// [`Error::Matching`] for landmarks that bring one loop to two; [`Error::Argument`] for a landmark that is no vertex.
pub(crate) fn loop_orders(surfaces: [&Surface; 2], landmarks: &[[VertexId; 2]]) -> Result<Vec<Vec<usize>>> {
    check_landmarks(surfaces, landmarks)?;
    let loops = [0, 1].map(|s| loops(surfaces[s]));
    let known = landmarked(surfaces, landmarks, &loops)?;
    Ok(orders(&loops, &known))
}

/// A boundary loop with the surface on its left, and its length.
type MeasuredLoop = (Vec<HalfedgeId>, f64);

/// Per loop of the source the loop of the target that landmarks on both say it goes to.
fn landmarked(
    surfaces: [&Surface; 2],
    landmarks: &[[VertexId; 2]],
    loops: &[Vec<MeasuredLoop>; 2],
) -> Result<Vec<Option<usize>>> {
    let mut loop_of = [0, 1].map(|s| vec![None; surfaces[s].mesh().n_vertices()]);
    for s in 0..2 {
        for (k, (around, _)) in loops[s].iter().enumerate() {
            around.iter().for_each(|&h| loop_of[s][surfaces[s].mesh().origin(h).index()] = Some(k));
        }
    }
    let pair_of = |pair: &[VertexId; 2]| Some([loop_of[0][pair[0].index()]?, loop_of[1][pair[1].index()]?]);
    let mut known = vec![None; loops[0].len()];
    let pairs: Vec<(usize, [usize; 2])> =
        landmarks.iter().enumerate().filter_map(|(k, pair)| Some((k, pair_of(pair)?))).collect();
    for (at, &(k, [a, b])) in pairs.iter().enumerate() {
        // Two landmarks conflict if they share a loop on one surface alone.
        if let Some((j, [c, d])) = pairs[..at].iter().find(|(_, [c, d])| (*c == a) != (*d == b)) {
            return Err(Error::Matching(format!(
                "landmarks {j} and {k} conflict: they bring loop {c} of the source to loop {d} of the target, and loop {a} to loop {b}: \
                 leave one of them out; --loops K,K,… says where each loop of the source goes"
            )));
        }
        known[a] = Some(b);
    }
    Ok(known)
}

fn orders(loops: &[Vec<MeasuredLoop>; 2], known: &[Option<usize>]) -> Vec<Vec<usize>> {
    let first = by_length(loops, known);
    let mut all = vec![first.clone()];
    let like = |x: f64, y: f64| (x - y).abs() <= LIKE * x.max(y);
    let mut done = 0;
    while done < all.len() {
        let order = all[done].clone();
        done += 1;
        for i in 0..order.len() {
            for j in i + 1..order.len() {
                if known[i].or(known[j]).is_some() {
                    continue;
                }
                let alike = (0..2).all(|s| {
                    let [a, b] = if s == 0 { [i, j] } else { [order[i], order[j]] };
                    like(loops[s][a].1, loops[s][b].1)
                });
                let mut next = order.clone();
                next.swap(i, j);
                if alike && !all.contains(&next) {
                    all.push(next);
                }
                if all.len() > MOST_ORDERS {
                    return vec![first];
                }
            }
        }
    }
    all
}

/// The target's loop for each of the source's: the known one, the others by descending length.
fn by_length(loops: &[Vec<MeasuredLoop>; 2], known: &[Option<usize>]) -> Vec<usize> {
    let is_free = |s: usize, k: &usize| match s {
        0 => known[*k].is_none(),
        _ => !known.contains(&Some(*k)),
    };
    let [first, second] = [0, 1].map(|s| {
        let mut order: Vec<usize> = (0..loops[s].len()).filter(|k| is_free(s, k)).collect();
        order.sort_by(|&i, &j| loops[s][j].1.total_cmp(&loops[s][i].1).then(i.cmp(&j)));
        order
    });
    let mut of: Vec<usize> = known.iter().map(|k| k.unwrap_or(0)).collect();
    first.into_iter().zip(second).for_each(|(i, j)| of[i] = j);
    of
}
