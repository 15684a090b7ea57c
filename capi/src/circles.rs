//! The circle pattern of a layout in the plane.

use crate::arrays::copy_out;
use crate::choice::choices;
use crate::guard;
use crate::layout::ricci_layout;
use crate::status::ricci_status;
use ricci::embed::CirclePattern;

choices!(enum CircleOwner, OWNERS = "which", [
    RICCI_CIRCLES_VERTICES => Vertex,
    RICCI_CIRCLES_FACES => Face,
]);

#[unsafe(no_mangle)]
pub unsafe extern "C" fn ricci_layout_circles(
    layout: *const ricci_layout,
    which: u32,
    circles: *mut f64,
    capacity: usize,
) -> ricci_status {
    guard::with(layout, |ricci_layout { layout, state, .. }| {
        let (which, solution) = (OWNERS.choose(which)?, &state.solution);
        let pattern = CirclePattern::new(layout, solution.mesh(), solution.metric())?;
        let n = match which {
            CircleOwner::Vertex => layout.coordinates.len(),
            CircleOwner::Face => solution.mesh().n_faces(),
        };
        let mut rows = vec![[f64::NAN; 3]; n];
        match which {
            CircleOwner::Vertex => pattern.vertex_circles.iter().for_each(|c| {
                let [x, y] = c.centre;
                rows[c.point] = [x, y, f64::from(c.epsilon) * c.radius * c.radius];
            }),
            CircleOwner::Face => pattern.dual_circles.iter().for_each(|(f, c)| {
                let [x, y] = c.centre;
                rows[f.index()] = [x, y, c.power];
            }),
        }
        copy_out("circles", &rows, circles, capacity)
    })
}
