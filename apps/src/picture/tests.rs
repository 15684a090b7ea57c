use super::checker::Checks;
use super::raster::{Paint, Primitive, render};
use super::*;
use ricci::mesh::shapes;

fn pixel(image: &[u8], x: usize, y: usize) -> [u8; 3] {
    let i = 3 * (y * PANEL + x);
    [image[i], image[i + 1], image[i + 2]]
}

fn covered(image: &[u8]) -> f64 {
    image.chunks_exact(3).filter(|p| **p != [255; 3]).count() as f64 / (PANEL * PANEL) as f64
}

fn surface<'a>(soup: &'a ricci::mesh::io::Soup, uv: Option<&'a [[[f64; 2]; 3]]>) -> Surface<'a> {
    Surface { positions: &soup.positions, faces: &soup.faces, corner_uv: uv, seams: &[], cones: &[] }
}

#[test]
fn a_sphere_fills_its_circle() {
    let soup = shapes::icosphere(20).unwrap();
    let image = render(&solid::primitives(&surface(&soup, None)), PANEL);
    let expected = std::f64::consts::FRAC_PI_4 * (1.0 - 2.0 * MARGIN).powi(2);
    assert!((covered(&image) - expected).abs() < 0.01, "{} of {expected}", covered(&image));
}

#[test]
fn the_nearer_triangle_hides_the_farther_one_in_either_order() {
    let whole = [[0.0, 0.0], [2000.0, 0.0], [0.0, 2000.0]];
    let triangle = |z: f64, color| Primitive { xy: whole, z: [z; 3], paint: Paint::Plain(color) };
    let (near, far) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    for order in [[triangle(1.0, near), triangle(0.0, far)], [triangle(0.0, far), triangle(1.0, near)]] {
        assert_eq!(pixel(&render(&order, PANEL), 100, 100), [255, 0, 0]);
    }
}

#[test]
fn neighbouring_triangles_leave_no_crack() {
    let soup = shapes::disk(9).unwrap();
    let white = |p: [f64; 2]| [p[0] * 437.0 + 450.0, p[1] * 437.0 + 450.0];
    let primitives: Vec<Primitive> = soup
        .faces
        .iter()
        .map(|f| f.map(|v| white([soup.positions[v as usize][0], soup.positions[v as usize][1]])))
        .map(|xy| Primitive { xy, z: [0.0; 3], paint: Paint::Plain([0.0; 3]) })
        .collect();
    let image = render(&primitives, PANEL);
    for (x, y) in (60..840).flat_map(|x| (60..840).map(move |y| (x, y))) {
        if (x as f64 - 450.0).hypot(y as f64 - 450.0) < 400.0 {
            assert_eq!(pixel(&image, x, y), [0; 3], "({x}, {y})");
        }
    }
}

#[test]
fn checks_finer_than_a_pixel_fade_to_their_mean() {
    let xy = [[0.0, 0.0], [2000.0, 0.0], [0.0, 2000.0]];
    let fine = checker::Checker::new(xy, 0.5, [0.0; 3], xy);
    assert_eq!(fine.value([0.3, 0.3, 0.4]), 0.5);
    let coarse = checker::Checker::new(xy, 50.0, [0.0; 3], xy);
    assert!([0.0, 1.0].contains(&coarse.value([0.3, 0.3, 0.4])));
    // Levels count octaves of eight from the median scale.
    let checks = Checks::new(&[1.0; 5], &[1.0, 1.0, 1.0, 64.0, 64.0 * 64.0]);
    assert!((checks.level[3] - 1.0).abs() < 1e-12 && (checks.level[4] - 2.0).abs() < 1e-12);
}

#[test]
fn degenerate_input_is_drawn_as_far_as_it_goes() {
    assert!(!png(&Picture { surface: None, flat: None }).unwrap().is_empty());
    let soup = ricci::mesh::io::Soup { positions: vec![[1.0; 3]; 3], faces: vec![[0, 1, 2]] };
    let uv = [[[1e300, 0.0], [f64::NAN, 1.0], [0.0, 1e-300]]];
    let flat =
        Flat { corner_uv: &uv, seams: &[], boundary: &[], cones: &[], circles: &[], dual_circles: &[] };
    assert!(
        !png(&Picture { surface: Some(surface(&soup, Some(&uv))), flat: Some(flat) }).unwrap().is_empty()
    );
    let mut svg = Vec::new();
    write_svg(&mut svg, &flat).unwrap();
    assert!(svg.ends_with(b"</svg>\n"));
}
