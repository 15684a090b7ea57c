//! Tests of the renderer: views, normals, hits and shade.

use super::camera::{Camera, Viewpoint};
use super::normals::corner_normals;
use super::occlusion::{Ground, SeenPoint, ShadowCaster};
use super::raster::{DrawnShape, Hit, render};
use super::vector::{V3, dot, norm, sub, unit};
use super::*;
use ricci::mesh::io::Soup;
use ricci::mesh::shapes;

const SIZE: usize = 240;

/// Paints every shape in one of two colours.
fn flags(_: [f64; 2], hit: Option<&Hit>) -> [f64; 3] {
    hit.map_or([1.0; 3], |h| if h.shape == 0 { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] })
}

fn style() -> Style {
    Style { size: SIZE, texture: TextureChoice::None, ground: false, ..Style::default() }
}

fn surface<'a>(soup: &'a Soup, uv: Option<&'a [[[f64; 2]; 3]]>) -> ShownSurface<'a> {
    ShownSurface {
        positions: &soup.positions,
        faces: &soup.faces,
        corner_uv: uv,
        seams: &[],
        cones: &[],
        is_closed: false,
    }
}

fn draw(surface: ShownSurface<'_>, style: &Style) -> PixelImage {
    Picture { surface: Some(surface), ..Picture::default() }.sheet(style).unwrap().image().unwrap()
}

fn pixels(image: &PixelImage) -> impl Iterator<Item = &[u8]> {
    image.rgba.chunks_exact(4).map(|p| &p[..3])
}

/// A cube of two triangles a side.
fn cube() -> Soup {
    let corner = |k: u32| [f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)];
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = squares.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Soup::new((0..8).map(corner).collect(), faces)
}

#[test]
fn a_sphere_fills_its_circle_and_touches_the_margins() {
    let soup = shapes::icosphere(20).unwrap();
    let image = draw(surface(&soup, None), &style());
    let covered = pixels(&image).filter(|p| **p != [255; 3]).count() as f64;
    let expected = std::f64::consts::FRAC_PI_4 * (1.0 - 2.0 * fit::MARGIN).powi(2) * (SIZE * SIZE) as f64;
    assert!((covered / expected - 1.0).abs() < 0.03, "{covered} of {expected}");
}

#[test]
fn every_view_fills_its_panel_to_the_margin_on_all_sides() {
    let soup = shapes::ellipsoid([3.0, 2.0, 1.0], 12).unwrap();
    for angles in [None, Some([0.3, 0.9]), Some([2.0, -0.4])] {
        let view = Viewpoint { angles, ..Viewpoint::default() };
        let image = draw(surface(&soup, None), &Style { view, ..style() });
        assert_eq!(image.width.max(image.height), SIZE, "{angles:?}");
        let used = |x: usize, y: usize| image.rgba[4 * (y * image.width + x)..][..3] != [255; 3];
        let margin = (SIZE as f64 * fit::MARGIN) as usize;
        let column = |x: usize| (0..image.height).any(|y| used(x, y));
        let row = |y: usize| (0..image.width).any(|x| used(x, y));
        let first_column = (0..image.width).find(|x| column(*x));
        let first_row = (0..image.height).find(|y| row(*y));
        let last_column = (0..image.width).rev().find(|x| column(*x)).map(|x| image.width - 1 - x);
        let last_row = (0..image.height).rev().find(|y| row(*y)).map(|y| image.height - 1 - y);
        for side in [first_column, last_column, first_row, last_row].into_iter().flatten() {
            assert!(side.abs_diff(margin) <= 1, "{side} of {margin} at {angles:?}");
        }
    }
}

#[test]
fn the_nearer_shape_hides_the_farther_one_in_either_order() {
    let triangle = |z: f64| DrawnShape::Triangle([[0.0, 0.0, z], [400.0, 0.0, z], [0.0, 400.0, z]]);
    let ball = |z: f64| DrawnShape::Capsule { ends: [[20.0, 20.0, z]; 2], radius: 5.0 };
    let middle = |shapes: &[DrawnShape]| {
        let image = render(shapes, [40; 2], flags);
        [image.rgba[4 * (20 * 40 + 20)], image.rgba[4 * (20 * 40 + 20) + 2]]
    };
    for other in [triangle(1.0), ball(-2.0)] {
        assert_eq!(middle(&[other, triangle(0.0)]), [255, 0]);
        assert_eq!(middle(&[triangle(0.0), other]), [0, 255]);
    }
    // A ball behind the triangle by more than its radius is hidden.
    assert_eq!(middle(&[ball(-6.0), triangle(0.0)]), [0, 255]);
}

#[test]
fn neighbouring_triangles_leave_no_crack() {
    let soup = shapes::disk(9).unwrap();
    let place = |v: u32| {
        let [x, y, _] = soup.positions[v as usize];
        [x * 93.7 + 100.0, y * 93.7 + 100.0, 0.0]
    };
    let shapes: Vec<DrawnShape> = soup.faces.iter().map(|f| DrawnShape::Triangle(f.map(place))).collect();
    let image = render(&shapes, [200; 2], flags);
    for (i, p) in pixels(&image).enumerate() {
        if (i as f64 % 200.0 - 100.0).hypot((i / 200) as f64 - 100.0) < 88.0 {
            assert_eq!(p[1], 0, "({}, {})", i % 200, i / 200);
        }
    }
}

#[test]
fn lines_behind_the_surface_are_hidden_and_cones_keep_their_colour() {
    let red = |image: &PixelImage| pixels(image).filter(|p| p[0] > 150 && p[1] < 90 && p[2] < 90).count();
    for shift in [0.0, 5.0, -5.0] {
        let mut soup = shapes::icosphere(6).unwrap();
        soup.positions.iter_mut().for_each(|p| p.iter_mut().for_each(|x| *x += shift));
        let cones: Vec<(u32, f64)> = (0..soup.positions.len() as u32).map(|v| (v, 1.0)).collect();
        let dots =
            |faces| red(&draw(ShownSurface { faces, cones: &cones, ..surface(&soup, None) }, &style()));
        let (seen, all) = (dots(&soup.faces), dots(&soup.faces[..1]));
        assert!(
            seen > 500 && (seen as f64) < 0.8 * all as f64,
            "{seen} of {all} with the surface at {shift}"
        );
    }
}

#[test]
fn creases_are_sharp_and_round_surfaces_smooth() {
    let soup = cube();
    for (face, normals) in soup.faces.iter().zip(corner_normals(&soup.positions, &soup.faces)) {
        let flat = unit(normal(face.map(|v| soup.positions[v as usize]))).unwrap();
        normals.iter().for_each(|n| assert!(norm(sub(*n, flat)) < 1e-12, "{n:?} on {flat:?}"));
    }
    // With a needle of no area on an edge of the cube, whose own direction is noise.
    let mut sliver = cube();
    sliver.positions.push([0.5, 1e-9, 1e-9]);
    sliver.faces.push([0, 1, 8]);
    let normals = corner_normals(&sliver.positions, &sliver.faces);
    assert!(normals.iter().flatten().all(|n| (norm(*n) - 1.0).abs() < 1e-12));
    assert!(normals[0].iter().all(|n| norm(sub(*n, [0.0, 0.0, -1.0])) < 1e-6), "{:?}", normals[0]);
    let ball = shapes::icosphere(10).unwrap();
    for (face, normals) in ball.faces.iter().zip(corner_normals(&ball.positions, &ball.faces)) {
        for (v, n) in face.iter().zip(normals) {
            assert!(dot(n, ball.positions[*v as usize]) > 0.9995);
        }
    }
}

/// A sphere of this radius at the origin that casts shadows.
fn sphere(radius: f64, key: V3) -> ShadowCaster {
    let soup = shapes::icosphere(12).unwrap();
    let points: Vec<V3> = soup.positions.iter().map(|p| p.map(|x| x * radius)).collect();
    ShadowCaster::new(&points, &soup.faces, key)
}

fn open(caster: &ShadowCaster, point: &SeenPoint) -> [f64; 2] {
    let open = caster.open(point);
    [open.sky, open.key]
}

#[test]
fn nothing_is_hidden_on_a_convex_body() {
    let key = unit([0.3, -0.8, 0.5]).unwrap();
    let caster = sphere(200.0, key);
    for k in 0..200 {
        let t = f64::from(k);
        let n = unit([t.sin(), (1.7 * t).cos(), (0.3 * t).sin()]).unwrap();
        let point = SeenPoint { xyz: n.map(|x| 200.0 * x), normal: n, flat: n, on_ground: false };
        let [sky, lit] = open(&caster, &point);
        assert_eq!(sky, 1.0, "{n:?}");
        if dot(n, key) > 0.2 {
            assert_eq!(lit, 1.0, "{n:?}");
        } else if dot(n, key) < -0.01 {
            assert_eq!(lit, 0.0, "{n:?}");
        }
    }
}

#[test]
fn a_sphere_throws_its_shadow_where_the_light_sends_it() {
    // z up; the light comes from (−1, 0, 1).
    let key = unit([-1.0, 0.0, 1.0]).unwrap();
    let caster = sphere(100.0, key);
    let up = [0.0, 0.0, 1.0];
    let ground = Ground { up, level: -100.0 };
    let at = |x: f64, y: f64| open(&caster, &ground.below([x, y]));
    // The middle of the shadow lies 100 to the right; the shadow is 100 wide across and √2 · 100 along.
    assert_eq!(at(100.0, 0.0)[1], 0.0);
    assert_eq!([at(-100.0, 0.0)[1], at(100.0, 150.0)[1], at(400.0, 0.0)[1]], [1.0; 3]);
    let half = at(100.0, 100.0)[1];
    assert!((half - 0.5).abs() < 0.15, "{half} at the edge of the shadow");
    // The sky: at distance d from the point of contact a ball of radius r hides r² h / (h² + d²)^{3/2} of it, with
    // h = r its height, as long as all of it is above the horizon.
    let mut before = 0.0;
    for d in [0.0f64, 50.0, 100.0, 200.0, 400.0] {
        let sky = at(-d, 0.0)[0];
        let expected = 1.0 - 1e6 / (1e4 + d * d).powf(1.5);
        assert!((sky - expected).abs() < 0.03, "{sky} of {expected} at {d}");
        assert!(sky >= before);
        before = sky;
    }
}

#[test]
fn a_picture_is_the_same_for_any_number_of_threads() {
    let soup = shapes::torus(2.0, 0.8, 24, 12).unwrap();
    let uv: Vec<[[f64; 2]; 3]> =
        soup.faces.iter().map(|f| f.map(|v| [f64::from(v / 12), f64::from(v % 12)])).collect();
    let values: Vec<f64> = soup.positions.iter().map(|p| p[0]).collect();
    let corners = soup.faces.iter().map(|f| f.map(|v| values[v as usize])).collect();
    let field = ColorField { corners, scale: ColorScale::of_signed("x", &values) };
    let seams = [(0, 1, 0), (1, 2, 1)];
    let surface = ShownSurface { seams: &seams, cones: &[(7, 1.0)], ..surface(&soup, Some(&uv)) };
    let flat = ShownLayout { corner_uv: &uv, ..ShownLayout::default() };
    let picture =
        Picture { surface: Some(surface), flat: Some(flat), field: Some(&field), ..Picture::default() };
    let style = Style { texture: TextureChoice::Circles, wire: true, ground: true, ..style() };
    let drawn = |threads| png(&picture, &Style { threads, ..style }).unwrap();
    let one = drawn(1);
    for threads in [2, 3, 0] {
        assert!(drawn(threads) == one, "{threads} threads");
    }
    // And the view that is chosen.
    let choose = || Ok(Camera::choose(&soup.positions, &soup.faces, &Viewpoint::default()).axes);
    let view = |threads| parallel::within(threads, choose).unwrap();
    assert_eq!(view(1), view(3));
}

#[test]
fn the_paper_stays_white_around_a_shadow() {
    let soup = shapes::icosphere(8).unwrap();
    let image = draw(surface(&soup, None), &Style { ground: true, ..style() });
    let (w, h) = (image.width, image.height);
    // The surface itself keeps away from the rim by more than that.
    let rim = |x: usize, y: usize| x.min(y).min(w - 1 - x).min(h - 1 - y) < SIZE * 3 / 100;
    for (i, p) in pixels(&image).enumerate().filter(|(i, _)| rim(i % w, i / w)) {
        assert!(p.iter().all(|c| *c >= 252), "{p:?} at ({}, {})", i % w, i / w);
    }
    assert!(pixels(&image).any(|p| p[0] == p[1] && p[1] == p[2] && p[0] < 220), "no shadow");
}

#[test]
fn of_two_layouts_each_is_cut_at_its_own_sides() {
    let rectangle = |w: f64, h: f64| [[[0.0, 0.0], [w, 0.0], [w, h]], [[0.0, 0.0], [w, h], [0.0, h]]];
    let [wide, narrow] = [rectangle(1.0, 1.0), rectangle(0.5, 1.0)];
    for [first, second] in [[&wide, &narrow], [&narrow, &wide]] {
        let flat = |corner_uv| Some(ShownLayout { corner_uv, ..ShownLayout::default() });
        let both = Picture { flat: flat(first), flat_beside: flat(second), ..Picture::default() };
        let image = both.sheet(&style()).unwrap().image().unwrap();
        let painted = pixels(&image).filter(|p| **p != [255; 3]).count() as f64;
        let side = (1.0 - 2.0 * fit::MARGIN) * SIZE as f64;
        assert!((painted / (1.5 * side * side) - 1.0).abs() < 0.03, "{painted} pixels");
    }
}

#[test]
fn drawings_are_well_formed_and_small() {
    let soup = shapes::disk(12).unwrap();
    let flat_of = |v: u32| [soup.positions[v as usize][0], soup.positions[v as usize][1]];
    let uv: Vec<[[f64; 2]; 3]> = soup.faces.iter().map(|f| f.map(flat_of)).collect();
    let border = region::border(soup.faces.iter().copied());
    let boundary: Vec<_> = border.iter().map(|&(a, b)| (flat_of(a), flat_of(b))).collect();
    let circles = [Circle { centre: [0.0; 2], radius: 0.5 }];
    let flat = ShownLayout {
        corner_uv: &uv,
        boundary: &boundary,
        cones: &[([0.1, 0.1], -1.0)],
        circles: &circles,
        ..ShownLayout::default()
    };
    let values: Vec<f64> = uv.iter().map(|t| t[0][0]).collect();
    let scale = ColorScale::of_signed("x & y < z", &values);
    let field = ColorField { corners: values.iter().map(|v| [*v; 3]).collect(), scale };
    for (texture, field) in [
        (TextureChoice::Checker, None),
        (TextureChoice::Circles, None),
        (TextureChoice::None, None),
        (TextureChoice::None, Some(&field)),
    ] {
        let drawn = Picture { flat: Some(flat), field, ..Picture::default() };
        let svg = svg(&drawn, &Style { texture, wire: field.is_none(), ..style() }).unwrap();
        let svg = String::from_utf8(svg).unwrap();
        resvg::usvg::roxmltree::Document::parse(&svg).unwrap();
        assert!(svg.ends_with("</svg>\n") && svg.contains("circles of the vertices"));
        // Of the colours each is a path, and so is each letter, also of the key; circles of the pattern are polygons.
        let limit = 50 * uv.len() + if texture == TextureChoice::Circles { 290_000 } else { 90_000 };
        assert!(svg.len() < limit, "{} bytes for {} faces", svg.len(), uv.len());
    }
}

#[test]
fn degenerate_input_is_drawn_as_far_as_it_goes() {
    assert!(!png(&Picture::default(), &style()).unwrap().is_empty());
    let uv = [[[1e300, 0.0], [f64::NAN, 1.0], [0.0, 1e-300]]];
    let flat = ShownLayout { corner_uv: &uv, ..ShownLayout::default() };
    let everything =
        Style { wire: true, ground: true, palette: true, texture: TextureChoice::Checker, ..style() };
    for positions in [vec![[1.0; 3]; 3], vec![[1e300; 3], [-1e300; 3], [1e-300; 3]], vec![[f64::NAN; 3]; 3]] {
        let soup = Soup::new(positions, vec![[0, 1, 2]]);
        let field =
            ColorField { corners: vec![[f64::NAN; 3]], scale: ColorScale::of_amounts("nothing", &[]) };
        let drawn = Picture {
            surface: Some(surface(&soup, Some(&uv))),
            flat: Some(flat),
            field: Some(&field),
            ..Picture::default()
        };
        assert!(!png(&drawn, &everything).unwrap().is_empty());
    }
    let svg = svg(&Picture { flat: Some(flat), ..Picture::default() }, &style()).unwrap();
    let svg = String::from_utf8(svg).unwrap();
    assert!(svg.ends_with("</svg>\n") && !svg.contains("NaN"));
}
