//! Texture atlases of whole models, on their own faces.

use ricci::mesh::io::{Soup, triangles_of_polygons};
use ricci::mesh::{Point, shapes, sheets::sheets};
use ricci::texture::{TextureAtlas, TextureOptions, texture_atlas};
use ricci::{Control, Error};

/// The six squares of a cube, each of two triangles.
fn cube() -> Soup {
    let positions = (0..8).map(|v| [0, 1, 2].map(|k| f64::from(v >> k & 1))).collect();
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = squares.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Soup::new(positions, faces)
}

fn atlas(soup: &Soup, options: &TextureOptions) -> TextureAtlas {
    let atlas = texture_atlas(soup, options, &Control::new()).unwrap();
    assert_eq!(atlas.corner_uv.len(), soup.faces.len());
    assert!(atlas.corner_uv.as_flattened().as_flattened().iter().all(|x| (0.0..1.0).contains(x)));
    assert_eq!((&atlas.folded, &atlas.overlapping), (&vec![], &vec![]));
    atlas
}

fn small() -> TextureOptions {
    TextureOptions { page: 128, fill: 0.0, threads: 1, ..TextureOptions::default() }
}

/// A model and another one, moved along x, without common vertices.
fn beside(mut soup: Soup, other: &Soup, shift: f64) -> Soup {
    let n = soup.positions.len() as u32;
    soup.positions.extend(other.positions.iter().map(|p| [p[0] + shift, p[1], p[2]]));
    soup.faces.extend(other.faces.iter().map(|f| f.map(|v| v + n)));
    soup
}

#[test]
fn a_cube_unfolds_without_stretch_along_seven_of_its_edges() {
    let whole = atlas(&cube(), &small());
    let quality = whole.quality;
    assert_eq!((whole.charts, whole.sheets), (1, 1));
    // A spanning tree of 8 corners has 7 edges; the area is 6.
    assert!((quality.seam_length - 7.0 / 6f64.sqrt()).abs() < 1e-9, "{quality:?}");
    assert!((quality.stretch_l2 - 1.0).abs() < 1e-4 && quality.stretch_max < 1.001, "{quality:?}");
    assert!(quality.angle_99 < 0.05 && quality.log_area_deviation < 1e-3, "{quality:?}");
    // The page is filled by 6 squares.
    let side = (quality.fill / 6.0).sqrt();
    assert!((quality.texel_density - 128.0 * side).abs() < 1e-9, "{quality:?}");
    let [a, b, _] = whole.corner_uv[0];
    assert!(((a[0] - b[0]).hypot(a[1] - b[1]) - side).abs() < 1e-4 * side);
    let filled = atlas(&cube(), &TextureOptions { fill: 0.68, ..small() });
    assert!(filled.quality.fill > quality.fill, "{} {}", filled.quality.fill, quality.fill);
}

#[test]
fn a_density_takes_the_pages_that_it_needs() {
    let options = TextureOptions { page: 32, density: 20.0, ..small() };
    let found = texture_atlas(&cube(), &options, &Control::new()).unwrap();
    assert_eq!((&found.folded, &found.overlapping, &found.placeless), (&vec![], &vec![], &vec![]));
    assert!((found.quality.texel_density - 20.0).abs() < 1e-2, "{:?}", found.quality);
    // A square of 20 texels along a side leaves no room for another one.
    assert!((6..=12).contains(&found.pages), "{}", found.pages);
    let half = 0.5 * (20.0 / 32.0) * (20.0 / 32.0);
    let mut filled = vec![0.0; found.pages];
    for (f, uv) in found.corner_uv.iter().enumerate() {
        let page = found.page(f);
        assert!(
            uv.iter().all(|[u, v]| u.floor() == f64::from(page % 10) && v.floor() == f64::from(page / 10)),
            "{uv:?}"
        );
        assert!(uv.as_flattened().iter().all(|x| (x * f64::from(1 << 20)).fract() == 0.0), "{uv:?}");
        let area = 0.5 * ricci::geometry::complex::doubled_area(*uv);
        assert!((area - half).abs() < 1e-3 * half, "{area}");
        filled[page as usize] += area;
    }
    assert!(filled.iter().all(|area| *area > 0.9 * half), "{filled:?}");
    assert!((found.quality.fill - 12.0 * half / found.pages as f64).abs() < 1e-3);
    // One page where that is enough, with the coordinates of one page.
    let one = atlas(&cube(), &TextureOptions { density: 20.0, ..small() });
    assert!(one.pages == 1 && (one.quality.texel_density - 20.0).abs() < 1e-2, "{:?}", one.quality);
    let refused = texture_atlas(&cube(), &TextureOptions { page: 16, ..options.clone() }, &Control::new());
    assert!(matches!(&refused, Err(Error::Layout(why)) if why.contains("larger than a page")), "{refused:?}");
    // Of 27 cubes each of 162 squares needs a page.
    let row = (0..27).fold(Soup::default(), |row, k| beside(row, &cube(), 2.0 * f64::from(k)));
    let refused = texture_atlas(&row, &options, &Control::new());
    assert!(matches!(&refused, Err(Error::Layout(why)) if why.contains("160 pages")), "{refused:?}");
}

#[test]
fn the_bound_of_the_stretch_holds_and_costs_seams() {
    let sphere = shapes::icosphere(3).unwrap();
    let found = [1.6, 1.15].map(|stretch| {
        let atlas = atlas(&sphere, &TextureOptions { stretch, ..small() });
        assert!(atlas.quality.stretch_99 <= 1.02 * stretch, "{:?}", atlas.quality);
        atlas.quality.seam_length
    });
    assert!(found[0] < found[1], "{found:?}");
}

#[test]
fn charts_keep_their_margin() {
    let model = beside(cube(), &shapes::icosphere(1).unwrap(), 5.0);
    let options = TextureOptions { margin: 4, page: 256, ..small() };
    let atlas = atlas(&model, &options);
    assert!(atlas.charts > 1);
    // Corners of different charts are farther apart than the margin, and from the border half of it.
    let corners: Vec<(u32, [f64; 2])> = atlas
        .corner_uv
        .iter()
        .zip(&atlas.chart)
        .flat_map(|(uv, k)| uv.map(|p| (*k, p.map(|x| 256.0 * x))))
        .collect();
    for (k, p) in &corners {
        assert!(p.iter().all(|x| (2.0..=254.0).contains(x)), "{p:?}");
        for (_, q) in corners.iter().filter(|(other, _)| other != k) {
            assert!((p[0] - q[0]).abs().max((p[1] - q[1]).abs()) >= 4.0, "{p:?} {q:?}");
        }
    }
}

#[test]
fn any_list_of_triangles_has_an_atlas() {
    // A wing on an edge of the cube, a face that names a vertex twice, one with a vertex in the place of another, one that is not finite.
    let mut model = beside(cube(), &shapes::disk(2).unwrap(), 3.0);
    let n = model.positions.len() as u32;
    model.positions.extend([[0.5, 0.5, 0.5], [1.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0]]);
    let before = model.faces.len() as u32;
    model.faces.extend([[0, 1, n], [0, 0, 2], [1, n + 1, 5], [0, 1, n + 2], [0, 1, n + 9]]);
    let found = atlas(&model, &small());
    assert_eq!((found.sheets, found.opened_edges), (3, 1));
    assert_eq!(found.placeless, [before + 1, before + 2, before + 3, before + 4]);
    assert!(found.placeless.iter().all(|f| found.chart[*f as usize] == TextureAtlas::NO_CHART));
    assert!((0..=before).all(|f| (found.chart[f as usize] as usize) < found.charts));
    let nothing = Soup::new(model.positions.clone(), vec![[0, 0, 1]]);
    let refused = texture_atlas(&nothing, &small(), &Control::new());
    assert!(matches!(refused, Err(Error::Layout(_))), "{refused:?}");
}

/// The size of a model does not matter, also where squares of its lengths leave the range of numbers.
#[test]
fn models_of_extreme_size_have_the_atlas_of_usual_ones() {
    let usual = atlas(&cube(), &small());
    for exponent in [-900.0, 700.0] {
        let size = f64::exp2(exponent);
        let mut model = cube();
        model.positions.as_flattened_mut().iter_mut().for_each(|x| *x *= size);
        let found = atlas(&model, &small());
        assert_eq!(found.corner_uv, usual.corner_uv);
        assert_eq!(found.quality.texel_density * size, usual.quality.texel_density);
    }
    // Beside a large face there is one whose lengths are too small to be measured.
    let tiny = [[0.0; 3], [1e-200, 0.0, 0.0], [0.0, 1e-200, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let found = atlas(&Soup::new(tiny.to_vec(), vec![[0, 3, 4], [0, 1, 2]]), &small());
    assert_eq!((found.chart, found.placeless.len()), (vec![0, 1], 0));
}

/// Faces that are thinner than the grid of the coordinates lie in charts of their own, and so do no others.
#[test]
fn needles_lie_in_charts_of_their_own() {
    let thin = 1e-9;
    let ends = [0.0, 1.0, 1.0 + thin, 2.0, 2.0 + thin, 3.0];
    let positions: Vec<Point> = ends.iter().flat_map(|&x| [[x, 0.0, 0.0], [x, 1.0, 0.0]]).collect();
    let column = |k: u32| [[2 * k, 2 * k + 2, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 1]];
    let strip = Soup::new(positions, (0..5).flat_map(column).collect());
    let found = atlas(&strip, &small());
    assert_eq!((found.placeless.len(), found.charts), (0, 3 + 4));
    for f in 0..10 {
        let sharing = found.chart.iter().filter(|k| **k == found.chart[f]).count();
        assert_eq!(sharing, if matches!(f / 2, 1 | 3) { 1 } else { 2 }, "{f}");
    }
    assert!(found.quality.stretch_99 < 1.01 && found.quality.stretch_max.is_finite(), "{:?}", found.quality);
}

#[test]
fn faces_that_run_against_their_neighbours_stay_in_the_chart() {
    let mut model = cube();
    model.faces[3].swap(1, 2);
    let found = atlas(&model, &small());
    assert_eq!((&found.turned, found.charts, found.sheets), (&vec![3], 1, 1));
    let area = |f: usize| {
        let [a, b, c] = found.corner_uv[f];
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    assert!((0..12).all(|f| (area(f) < 0.0) == (f == 3)));
    assert!((found.quality.seam_length - 7.0 / 6f64.sqrt()).abs() < 1e-9);
}

#[test]
fn a_strip_with_one_side_is_opened() {
    let at = |k: usize, side: f64| -> Point {
        let t = std::f64::consts::PI * k as f64 / 8.0;
        let r = 1.0 + side * 0.2 * (0.5 * t).cos();
        [r * t.cos(), r * t.sin(), 0.2 * side * (0.5 * t).sin()]
    };
    let positions: Vec<Point> = (0..16).flat_map(|k| [at(k, -1.0), at(k, 1.0)]).collect();
    let quad = |k: u32| {
        let [a, b] = [2 * k, 2 * k + 1];
        let [c, d] = if k == 15 { [1, 0] } else { [2 * k + 2, 2 * k + 3] };
        [[a, c, d], [a, d, b]]
    };
    let strip = Soup::new(positions, (0..16).flat_map(quad).collect());
    let open = sheets(&strip);
    assert_eq!((open.sheets.len(), open.opened_edges), (1, 1));
    assert_eq!(open.sheets[0].origins.len(), 34);
    let found = atlas(&strip, &small());
    assert_eq!((found.sheets, found.placeless.len()), (1, 0));
}

#[test]
fn split_vertices_have_one_place_each() {
    let mut model = cube();
    model.faces.push([3, 3, 5]);
    let found = atlas(&model, &small());
    let split = found.split(&model.faces);
    // A disk of 12 triangles with 14 sides on its border, both of 7 seams: 25 edges − 12 + 1 = 14 vertices.
    assert_eq!((split.faces.len(), split.uv.len()), (12, 14));
    assert_eq!(split.face_origin, (0..12).collect::<Vec<u32>>());
    for (face, f) in split.faces.iter().zip(&split.face_origin) {
        assert_eq!(face.map(|v| split.vertex_origin[v as usize]), model.faces[*f as usize]);
        assert_eq!(face.map(|v| split.uv[v as usize]), found.corner_uv[*f as usize]);
    }
}

#[test]
fn polygons_become_triangles_that_know_them() {
    // An arrow, which no fan from its first corner covers, and a polygon of two corners.
    let arrow = vec![[0.5, 1.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.0], [2.0, 1.0, 0.0]];
    let found = triangles_of_polygons(arrow, &[1, 2, 0, 3, 3, 0, 2, 3], &[0, 4, 6, 8]).unwrap();
    assert_eq!((found.soup.faces.len(), &found.polygon[..]), (2, &[0, 0][..]));
    let area = |[a, b, c]: [u32; 3]| {
        let [p, q, r] = [a, b, c].map(|v| found.soup.positions[v as usize]);
        0.5 * ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))
    };
    assert!(found.soup.faces.iter().all(|f| area(*f) > 0.0), "{:?}", found.soup.faces);
    for starts in [&[0, 4, 3][..], &[1, 4], &[0, 4], &[]] {
        let refused = triangles_of_polygons(Vec::new(), &[0, 1, 2, 3, 4], starts);
        assert!(matches!(refused, Err(Error::Argument { .. })), "{starts:?}: {refused:?}");
    }
}

#[test]
fn the_atlas_is_the_same_for_any_number_of_threads() {
    let model = shapes::torus(2.0, 0.7, 14, 8).unwrap();
    let one = atlas(&model, &small());
    assert_eq!(one, atlas(&model, &TextureOptions { threads: 3, ..small() }));
}

#[test]
fn options_outside_their_ranges_are_refused_and_work_is_cancelled() {
    let usual = small();
    for options in [
        TextureOptions { stretch: 1.0, ..usual.clone() },
        TextureOptions { stretch: f64::NAN, ..usual.clone() },
        TextureOptions { page: 1000, ..usual.clone() },
        TextureOptions { margin: 17, ..usual.clone() },
        TextureOptions { fill: 1.5, ..usual.clone() },
    ] {
        let refused = texture_atlas(&cube(), &options, &Control::new());
        assert!(matches!(refused, Err(Error::Argument { .. })), "{options:?}: {refused:?}");
    }
    let control = Control::new();
    control.cancel();
    assert_eq!(texture_atlas(&cube(), &usual, &control), Err(Error::Cancelled));
}
