//! The picture of a circle domain: the surface beside its layout, whose holes are drawn as circles.

use super::outcome::CirclesOutcome;
use crate::failure::Failure;
use crate::picture::{self, Circle, Picture, ShownLayout, ShownSurface, Style};
use ricci::geometry::Space;
use ricci::mesh::HalfedgeId;

/// Largest distance of the points of a loop from its circle, as a share of the radius, up to which the loop is drawn as that circle. The
/// cut can divide other loops into arcs of several circles.
const WHOLE: f64 = 1e-6;

pub fn draw(outcome: &CirclesOutcome, style: &Style, is_svg: bool) -> Result<Vec<u8>, Failure> {
    let laid = &outcome.laid;
    let mesh = laid.mesh();
    let corner_uv: Vec<_> = mesh.faces().map(|f| laid.face_uv(f)).collect();
    let side = |h: HalfedgeId| (laid.corner_uv(h), laid.corner_uv(mesh.next(h)));
    let (mut edges, mut seams) = (Vec::new(), Vec::new());
    for (h, number) in laid.seams() {
        edges.push((mesh.origin(h).0, mesh.tip(h).0, number));
        for h in [h, h.twin()] {
            let (a, b) = side(h);
            seams.push((a, b, number));
        }
    }
    let (mut holes, mut rims, mut boundary) = (Vec::new(), Vec::new(), Vec::new());
    for rim in mesh.boundary_loops() {
        let rim: Vec<HalfedgeId> = rim.into_iter().map(HalfedgeId::twin).collect();
        match outcome
            .domain
            .circles
            .iter()
            .map(|c| poincare_circle(outcome, c))
            .find(|c| is_on(laid.corner_uv(rim[0]), c))
        {
            Some(circle) if rim.iter().all(|&h| is_on(laid.corner_uv(h), &circle)) => {
                // The surface lies inside the outer circle.
                let is_outer =
                    outcome.domain.outer.is_some() && circle.centre == [0.0; 2] && circle.radius == 1.0;
                if is_outer { rims.push(circle) } else { holes.push(circle) }
            }
            _ => boundary.extend(rim.into_iter().map(side)),
        }
    }
    let flat = ShownLayout {
        corner_uv: &corner_uv,
        seams: &seams,
        boundary: &boundary,
        holes: &holes,
        rims: &rims,
        ..ShownLayout::default()
    };
    let faces = mesh.triangles();
    let surface = laid.positions.as_deref().filter(|_| !is_svg).map(|positions| ShownSurface {
        positions,
        faces: &faces,
        corner_uv: Some(&corner_uv),
        seams: &edges,
        cones: &[],
        is_closed: false,
    });
    let drawn = Picture { surface, flat: Some(flat), ..Picture::default() };
    if is_svg { picture::svg(&drawn, style) } else { picture::png(&drawn, style) }
}

/// A circle of the domain in the coordinates of the layout. In the Poincaré disk its Euclidean centre and radius are not the hyperbolic
/// ones.
fn poincare_circle(outcome: &CirclesOutcome, circle: &ricci::canonical::DomainCircle) -> Circle {
    let (centre, radius) = (circle.centre, circle.radius);
    if outcome.domain.layout.space != Space::H2 {
        return Circle { centre, radius };
    }
    let reach = (0.5 * radius).tanh().powi(2);
    let far = centre[0] * centre[0] + centre[1] * centre[1];
    let scale = 1.0 - reach * far;
    Circle { centre: centre.map(|x| x * (1.0 - reach) / scale), radius: reach.sqrt() * (1.0 - far) / scale }
}

fn is_on([x, y]: [f64; 2], circle: &Circle) -> bool {
    let distance = (x - circle.centre[0]).hypot(y - circle.centre[1]);
    (distance - circle.radius).abs() <= WHOLE * circle.radius
}
