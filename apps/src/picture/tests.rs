use super::checker::{Checker, Tiles};
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
    let image = render(&solid::primitives(&surface(&soup, None), None), PANEL, 0);
    let expected = std::f64::consts::FRAC_PI_4 * (1.0 - 2.0 * MARGIN).powi(2);
    assert!((covered(&image) - expected).abs() < 0.01, "{} of {expected}", covered(&image));
}

#[test]
fn the_nearer_triangle_hides_the_farther_one_in_either_order() {
    let whole = [[0.0, 0.0], [2000.0, 0.0], [0.0, 2000.0]];
    let triangle = |z: f64, color| Primitive { xy: whole, z: [z; 3], paint: Paint::Plain(color) };
    let (near, far) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    for order in [[triangle(1.0, near), triangle(0.0, far)], [triangle(0.0, far), triangle(1.0, near)]] {
        assert_eq!(pixel(&render(&order, PANEL, 0), 100, 100), [255, 0, 0]);
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
    let image = render(&primitives, PANEL, 2);
    for (x, y) in (60..840).flat_map(|x| (60..840).map(move |y| (x, y))) {
        if (x as f64 - 450.0).hypot(y as f64 - 450.0) < 400.0 {
            assert_eq!(pixel(&image, x, y), [0; 3], "({x}, {y})");
        }
    }
}

#[test]
fn checks_finer_than_a_pixel_fade_to_their_mean() {
    let xy = [[0.0, 0.0], [2000.0, 0.0], [0.0, 2000.0]];
    let tiles = |size| Tiles { size, level: vec![[0.0; 3]] };
    assert_eq!(Checker::new(xy, &tiles(0.5), 0, xy).value([0.3, 0.3, 0.4]), 0.5);
    assert!([0.0, 1.0].contains(&Checker::new(xy, &tiles(50.0), 0, xy).value([0.3, 0.3, 0.4])));
    // Levels count octaves of eight from the median scale.
    let faces: Vec<[u32; 3]> = (0..5).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    let tiles = Tiles::new(&[1.0; 5], &[1.0, 1.0, 1.0, 64.0, 64.0 * 64.0], &faces, 15);
    assert!((tiles.level[3][0] - 1.0).abs() < 1e-12 && (tiles.level[4][2] - 2.0).abs() < 1e-12);
}

#[test]
fn dots_keep_their_colour_wherever_the_surface_lies() {
    for shift in [0.0, 5.0, -5.0] {
        let mut soup = shapes::icosphere(6).unwrap();
        soup.positions.iter_mut().for_each(|p| p.iter_mut().for_each(|x| *x += shift));
        let cones: Vec<(u32, f64)> = (0..soup.positions.len() as u32).map(|v| (v, 1.0)).collect();
        let surface = Surface { cones: &cones, ..surface(&soup, None) };
        let image = render(&solid::primitives(&surface, None), PANEL, 0);
        let red = image.chunks_exact(3).filter(|p| p[0] > 200 && p[1] < 80 && p[2] < 80).count();
        assert!(red > 5000, "{red} red pixels with the surface moved by {shift}");
    }
}

#[test]
fn lines_behind_the_surface_are_hidden() {
    // Seams all over a sphere: with its faces only those of the near half show.
    let soup = shapes::icosphere(3).unwrap();
    let seams: Vec<(u32, u32, usize)> = soup.faces.iter().map(|f| (f[0], f[1], 0)).collect();
    let count = |faces: &[[u32; 3]]| {
        let surface = Surface { faces, seams: &seams, ..surface(&soup, None) };
        let image = render(&solid::primitives(&surface, None), PANEL, 0);
        image.chunks_exact(3).filter(|p| p[0] > 180 && p[1] < 90 && p[2] < 90).count()
    };
    let (hidden, all) = (count(&soup.faces), count(&[]));
    assert!(hidden > 1000 && (hidden as f64) < 0.7 * all as f64, "{hidden} of {all}");
}

#[test]
fn degenerate_input_is_drawn_as_far_as_it_goes() {
    assert!(!png(&Picture { surface: None, flat: None }, 1).unwrap().is_empty());
    let soup = ricci::mesh::io::Soup::new(vec![[1.0; 3]; 3], vec![[0, 1, 2]]);
    let uv = [[[1e300, 0.0], [f64::NAN, 1.0], [0.0, 1e-300]]];
    let flat =
        Flat { corner_uv: &uv, seams: &[], boundary: &[], cones: &[], circles: &[], dual_circles: &[] };
    assert!(
        !png(&Picture { surface: Some(surface(&soup, Some(&uv))), flat: Some(flat) }, 2).unwrap().is_empty()
    );
    let mut svg = Vec::new();
    write_svg(&mut svg, &flat).unwrap();
    let svg = String::from_utf8(svg).unwrap();
    assert!(svg.ends_with("</svg>\n") && !svg.contains("NaN"));
}
