//! The postorder of an order of elimination: an equivalent order, whose factor differs only in the order of its rows, and in which the
//! columns of every subtree of the elimination tree follow each other.

use super::Pattern;

const NONE: u32 = u32::MAX;

/// The postorder of an order of elimination; `forward[k]` is the row that is eliminated k-th.
pub(super) fn postorder(pattern: &Pattern, forward: &[u32]) -> Vec<u32> {
    let parent = elimination_tree(pattern, forward);
    let n = parent.len();
    // The number of columns in each subtree: the largest one comes last, so that it can share a supernode with its parent.
    let mut size = vec![1u32; n];
    for j in 0..n {
        if parent[j] != NONE {
            size[parent[j] as usize] += size[j];
        }
    }
    // Linked lists of children; the head is visited first.
    let [mut head, mut next, mut largest] = [(); 3].map(|()| vec![NONE; n]);
    for j in (0..n as u32).rev() {
        let p = parent[j as usize];
        if p == NONE {
            continue;
        }
        let p = p as usize;
        let other = largest[p];
        let smaller = if other == NONE || size[j as usize] > size[other as usize] {
            largest[p] = j;
            other
        } else {
            j
        };
        if smaller != NONE {
            next[smaller as usize] = head[p];
            head[p] = smaller;
        }
    }
    drop(size);
    let mut order = Vec::with_capacity(n);
    let mut path = Vec::new();
    for root in (0..n as u32).filter(|&j| parent[j as usize] == NONE) {
        path.push(root);
        while let Some(&j) = path.last() {
            let j_ = j as usize;
            if head[j_] != NONE {
                let child = head[j_];
                head[j_] = next[child as usize];
                path.push(child);
            } else if largest[j_] != NONE {
                path.push(std::mem::replace(&mut largest[j_], NONE));
            } else {
                order.push(forward[j_]);
                path.pop();
            }
        }
    }
    order
}

/// The parent of each column in the elimination tree \[Liu90\]; columns are numbered in the order of elimination.
fn elimination_tree(pattern: &Pattern, forward: &[u32]) -> Vec<u32> {
    let n = forward.len();
    let mut inverse = vec![0u32; n];
    (0..).zip(forward).for_each(|(k, &i)| inverse[i as usize] = k);
    // Rows of the lower triangle in the new order: the earlier neighbours of each column.
    let mut start = vec![0u32; n + 1];
    let pairs = || {
        (0..n).flat_map(|j| {
            let column = pattern.column_start[j] as usize + 1..pattern.column_start[j + 1] as usize;
            let b = inverse[j];
            column.map(move |k| (k, b))
        })
    };
    let later = |(k, b): (usize, u32)| {
        let a = inverse[pattern.row[k] as usize];
        (a.max(b), a.min(b))
    };
    pairs().map(later).for_each(|(late, _)| start[late as usize + 1] += 1);
    (0..n).for_each(|k| start[k + 1] += start[k]);
    let mut earlier = vec![0u32; start[n] as usize];
    let mut end = start.clone();
    for (late, early) in pairs().map(later) {
        earlier[end[late as usize] as usize] = early;
        end[late as usize] += 1;
    }
    let [mut parent, mut ancestor] = [(); 2].map(|()| vec![NONE; n]);
    for k in 0..n {
        for &i in &earlier[start[k] as usize..start[k + 1] as usize] {
            let mut i = i as usize;
            while i != k {
                let above = std::mem::replace(&mut ancestor[i], k as u32);
                if above == NONE {
                    parent[i] = k as u32;
                    break;
                }
                i = above as usize;
            }
        }
    }
    parent
}
