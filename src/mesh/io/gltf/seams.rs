//! Identification of vertices that glTF repeats for each pair of texture coordinates and each normal of their corners.

/// For each of these vertices the first of them with the same key. Sorting takes 8 bytes of temporary memory per vertex, where a hash
/// table would take more memory than the vertices.
pub(super) fn first_alike<K: Ord>(vertices: std::ops::Range<u32>, key: impl Fn(u32) -> K) -> Vec<u32> {
    let mut order: Vec<u32> = vertices.clone().collect();
    order.sort_unstable_by_key(|&v| (key(v), v));
    let mut first: Vec<u32> = vertices.clone().collect();
    for alike in order.chunk_by(|&a, &b| key(a) == key(b)) {
        alike.iter().for_each(|v| first[(v - vertices.start) as usize] = alike[0]);
    }
    first
}
