//! Tests that normals, colours and texture coordinates survive every format, with hard edges, seams and gaps.

use crate::common;
use crate::common::Random;
use ricci::Error;
use ricci::control::Control;
use ricci::mesh::io::{self, Attributes, FaceLabel, FaceLabels, Format, NumberColumn, NumberType, Soup};
use ricci::mesh::repair::{Repair, repair};
use ricci::mesh::{Mesh, shapes};
use std::path::Path;

/// The soup after it was written under this name and read back, and the attributes that were left out.
fn through(name: &str, soup: &Soup) -> (Soup, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    let left_out = io::write(&path, soup).unwrap();
    (io::read(&path).unwrap(), left_out)
}

/// A cube of eight vertices with the normals of its sides, each side with the whole texture.
fn cube() -> Soup {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 -1\nvn 0 0 1\nvn 0 -1 0\nvn 1 0 0\nvn 0 1 0\nvn -1 0 0\n\
                f 4/1/1 3/2/1 2/3/1 1/4/1\nf 5/1/2 6/2/2 7/3/2 8/4/2\nf 1/1/3 2/2/3 6/3/3 5/4/3\n\
                f 2/1/4 3/2/4 7/3/4 6/4/4\nf 3/1/5 4/2/5 8/3/5 7/4/5\nf 4/1/6 1/2/6 5/3/6 8/4/6\n";
    io::parse_obj(text.as_bytes(), "cube.obj").unwrap()
}

#[test]
fn hard_edges_keep_a_normal_for_each_corner() {
    let cube = cube();
    let normals = cube.attributes.corner_normals.clone().unwrap();
    assert_eq!((cube.attributes.normals.clone(), cube.positions.len(), normals.len()), (None, 8, 12));
    // Each is the normal of its face, by the vector product.
    for (face, normals) in cube.faces.iter().zip(&normals) {
        let [a, b, c] = face.map(|v| cube.positions[v as usize]);
        let (p, q): ([f64; 3], [f64; 3]) =
            (std::array::from_fn(|k| b[k] - a[k]), std::array::from_fn(|k| c[k] - a[k]));
        let product = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        assert_eq!(*normals, [product; 3]);
    }
    let (back, left_out) = through("m.obj", &cube);
    assert!(back == cube && left_out.is_empty());
    let (back, left_out) = through("m.glb", &cube);
    assert!(back == cube && left_out.is_empty());
    // Repair keeps them at their corners, also where it turns a face around.
    let mut torn = cube.clone();
    torn.faces[3].swap(1, 2);
    torn.attributes.corner_normals.as_mut().unwrap()[3].swap(1, 2);
    torn.attributes.uv.as_mut().unwrap()[3].swap(1, 2);
    let mended = repair(&torn, &Repair::default(), &Control::new()).unwrap();
    assert_eq!(mended.steps.turned_faces, 1);
    assert!(mended.soup == cube);
}

#[test]
fn what_a_format_has_no_place_for_is_named() {
    let cube = cube();
    let hard = "normals at hard edges: the format has one per vertex";
    let (back, left_out) = through("m.ply", &cube);
    assert_eq!(left_out, [hard]);
    let rest = Attributes { corner_normals: None, ..cube.attributes.clone() };
    assert_eq!((&back.faces, &back.attributes), (&cube.faces, &rest));
    let (back, left_out) = through("m.off", &cube);
    assert_eq!(
        left_out,
        [hard, "texture coordinates, for they have seams: the format has one pair per vertex"]
    );
    assert_eq!((&back.faces, back.attributes), (&cube.faces, Attributes::default()));
    let smooth = Soup { attributes: Attributes::default(), ..cube };
    for name in ["m.obj", "m.off", "m.ply", "m.glb"] {
        assert_eq!(through(name, &smooth), (smooth.clone(), Vec::new()));
    }
}

/// Attributes of every kind that 32 bits hold: seams in half of the corners, hard edges at a third of the faces.
fn decorate(soup: &mut Soup, hard: bool) {
    let mut random = Random::new(soup.faces.len() as u64);
    let mut flip = move || random.symmetric() > 0.0;
    let axis = |k: usize| -> [f64; 3] { std::array::from_fn(|i| f64::from(i == k % 3)) };
    let colors = (0..soup.positions.len()).map(|v| [(v % 5) as f64 / 4.0, 0.5, 1.0, 0.25]).collect();
    let uv = |v: u32| [f64::from(v % 64) / 64.0, if flip() { 0.25 } else { 0.75 }];
    soup.attributes.uv = Some(
        soup.faces
            .iter()
            .map({
                let mut uv = uv;
                move |f| f.map(&mut uv)
            })
            .collect(),
    );
    soup.attributes.colors = Some(colors);
    if hard {
        let normals = |(f, corners): (usize, &[u32; 3])| match f % 3 {
            0 => [axis(f / 3); 3],
            _ => corners.map(|v| axis(v as usize)),
        };
        soup.attributes.corner_normals = Some(soup.faces.iter().enumerate().map(normals).collect());
    } else {
        soup.attributes.normals = Some((0..soup.positions.len()).map(axis).collect());
    }
}

fn survives(soup: &Soup, what: &str) {
    for name in ["m.obj", "m.glb"] {
        let (back, left_out) = through(name, soup);
        assert!(left_out.is_empty());
        assert!(back.faces == soup.faces, "{what} as {name}: other faces");
        assert!(back.positions.len() == soup.positions.len(), "{what} as {name}: other vertices");
        assert!(back.attributes == soup.attributes, "{what} as {name}: other attributes");
        assert_eq!(Mesh::from_soup(&back).is_ok(), Mesh::from_soup(soup).is_ok());
    }
    let (back, _) = through("m.ply", soup);
    let Attributes { normals, uv, .. } = &soup.attributes;
    assert!(
        (&back.faces, &back.attributes.normals, &back.attributes.uv) == (&soup.faces, normals, uv),
        "{what}"
    );
}

#[test]
fn surfaces_with_seams_and_hard_edges_keep_their_connectivity() {
    let shapes = [shapes::genus(2, 3), shapes::torus(2.0, 1.0, 12, 8), shapes::disk(4), shapes::icosphere(3)];
    for (i, shape) in shapes.into_iter().enumerate() {
        for hard in [false, true] {
            let mut soup = shape.clone().unwrap();
            decorate(&mut soup, hard);
            survives(&soup, &format!("shape {i}"));
        }
    }
    let Some((folder, rows)) = common::index("good") else { return };
    let mut tried = 0;
    for row in rows.iter().filter(|row| row["F"].parse().is_ok_and(|n: usize| n < 6000)) {
        let mut soup = io::read(&folder.join(&row["file"])).unwrap();
        soup.attributes = Attributes::default();
        decorate(&mut soup, tried % 2 == 0);
        survives(&soup, &row["name"]);
        tried += 1;
    }
    assert!(tried > 20, "{tried}");
}

#[test]
fn vertices_in_one_place_stay_two_in_our_glb_and_become_one_in_that_of_others() {
    // Two triangles that meet in an edge, each with vertices of its own there: a slit.
    let (a, b, c, d) = ([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]);
    let slit = Soup::new(vec![a, b, c, b, d, c], vec![[0, 1, 2], [3, 4, 5]]);
    for hard in [false, true] {
        let mut slit = slit.clone();
        decorate(&mut slit, hard);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.glb");
        io::write(&path, &slit).unwrap();
        let ours = io::read(&path).unwrap();
        assert_eq!((&ours.positions, &ours.faces), (&slit.positions, &slit.faces));
        let theirs = anonymous(&path);
        assert_eq!(
            (&theirs.positions[..], &theirs.faces[..]),
            (&[a, b, c, d][..], &[[0, 1, 2], [1, 3, 2]][..])
        );
        assert_eq!(theirs.attributes.uv, slit.attributes.uv);
    }
    // Positions that 32 bits do not distinguish.
    let mut close =
        Soup::new(vec![a, b, [0.1, 1.0, 0.0], [0.1 + 1e-16, 1.0, 0.0]], vec![[0, 1, 2], [1, 0, 3]]);
    close.positions[3][0] = 0.1f64.next_up();
    assert_eq!(through("m.glb", &close).0.faces, close.faces);
}

/// The file without this library's attribute, whose name is replaced by another of the same length.
fn anonymous(path: &Path) -> Soup {
    let bytes = std::fs::read(path).unwrap();
    let name = b"_RICCI_VERTEX";
    let at = bytes.windows(name.len()).position(|w| w == name).unwrap();
    let bytes = [&bytes[..at], b"_OTHER_VERTEX", &bytes[at + name.len()..]].concat();
    io::parse_glb(&bytes, "t.glb").unwrap()
}

#[test]
fn what_some_elements_lack_is_filled_up() {
    // A texture on all faces but one, a colour at all vertices but one, a normal at one corner.
    let text = "v 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0 0 0 1\nv 0 1 0 0 1 0 0.5\nvt 0.5 0.25\nvn 0 0 2\n\
                f 1/1 2/1 3/1\nf 1 3//1 4\n";
    let soup = io::parse_obj(text.as_bytes(), "t.obj").unwrap();
    let Attributes { normals, corner_normals, colors, uv, .. } = soup.attributes;
    assert_eq!(uv.unwrap(), [[[0.5, 0.25]; 3], [[0.0; 2]; 3]]);
    let white = [1.0; 4];
    assert_eq!(colors.unwrap(), [[1.0, 0.0, 0.0, 1.0], white, [0.0, 0.0, 1.0, 1.0], [0.0, 1.0, 0.0, 0.5]]);
    let zero = [0.0; 3];
    assert_eq!((normals.unwrap(), corner_normals), (vec![zero, zero, [0.0, 0.0, 2.0], zero], None));
    let text = "STCNOFF\n3 1 0\n0 0 0 0 0 1 255 0 51 0.5 0.25\n1 0 0\n1 1 0 0 1 0 0 255 0 1 1\n3 0 1 2\n";
    let Attributes { normals, colors, uv, .. } = io::parse_off(text.as_bytes(), "t.off").unwrap().attributes;
    assert_eq!(normals.unwrap(), [[0.0, 0.0, 1.0], zero, [0.0, 1.0, 0.0]]);
    assert_eq!(colors.unwrap(), [[1.0, 0.0, 0.2, 1.0], white, [0.0, 1.0, 0.0, 1.0]]);
    assert_eq!(uv.unwrap(), [[[0.5, 0.25], [0.0; 2], [1.0; 2]]]);
    // A file without attributes.
    let none = "COFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n";
    assert_eq!(io::parse_off(none.as_bytes(), "t.off").unwrap().attributes, Attributes::default());
}

/// A closed surface of four faces and an isolated vertex, with names of its faces, and with further numbers of vertices and faces.
fn labelled() -> Soup {
    let positions = (0..5).map(|v| [f64::from(v % 2), f64::from(v / 2 % 2), f64::from(v / 4)]).collect();
    let mut soup = Soup::new(positions, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
    let label = |group: &str, material: &str| FaceLabel {
        object: "whole thing".into(),
        group: group.into(),
        material: material.into(),
        smoothing: "off".into(),
    };
    let column =
        |name: &str, kind, values: &[f64]| NumberColumn { name: name.into(), kind, values: values.to_vec() };
    let attributes = &mut soup.attributes;
    attributes.labels = Some(FaceLabels {
        libraries: vec!["a b.mtl".into(), "c.mtl".into()],
        labels: vec![label("left", "Red #1"), label("left", "Blü"), label("right side", "Red #1")],
        of_face: vec![0, 1, 1, 2],
        materials: Vec::new(),
    });
    attributes.vertex_numbers = vec![
        column("quality", NumberType::F32, &[0.5, 1.0, -2.0, 0.0, 1048576.0]),
        column("label", NumberType::I16, &[-3.0, 0.0, 7.0, 1.0, 300.0]),
    ];
    attributes.face_numbers = vec![column("region", NumberType::U8, &[1.0, 2.0, 3.0, 255.0])];
    soup
}

#[test]
fn names_and_numbers_go_to_the_format_that_holds_them() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let soup = labelled();
    let names = "2 materials, 2 groups, 1 object name: only OBJ has them";
    let numbers = ["numbers of vertices `quality`, `label`", "numbers of faces `region`"]
        .map(|n| format!("{n}: only PLY and VTK have them"));
    assert_eq!(io::write(&at("m.obj"), &soup).unwrap(), numbers);
    assert_eq!(io::read(&at("m.obj")).unwrap().attributes.labels, soup.attributes.labels);
    assert_eq!(io::write(&at("m.ply"), &soup).unwrap(), [names]);
    let mut expected = soup.clone();
    expected.attributes.labels = None;
    assert_eq!(io::read(&at("m.ply")).unwrap(), expected);
    assert_eq!(soup.attributes.unheld(Format::Off), [&[names.to_string()], &numbers[..]].concat());
    // glTF has the names of materials, stretch by stretch.
    let left = ["2 groups, 1 object name, a b.mtl, c.mtl: only OBJ has them".to_string()];
    assert_eq!(io::write(&at("m.glb"), &soup).unwrap(), [&left[..], &numbers[..]].concat());
    let read = io::read(&at("m.glb")).unwrap();
    assert_eq!((read.positions.len(), &read.faces), (soup.positions.len(), &soup.faces));
    let names = |soup: &Soup| -> Vec<String> {
        let labels = soup.attributes.labels.as_ref().unwrap();
        labels.of_face.iter().map(|&k| labels.labels[k as usize].material.clone()).collect()
    };
    assert_eq!(names(&read), names(&soup));
    // The look of a material goes to glTF and back, and is told where it does not go.
    let mut shining = read;
    for material in &mut shining.attributes.labels.as_mut().unwrap().materials {
        (material.base_color, material.metallic, material.roughness) = ([0.5, 0.25, 1.0, 0.75], 0.5, 0.125);
    }
    assert!(io::write(&at("s.glb"), &shining).unwrap().is_empty());
    let again = io::read(&at("s.glb")).unwrap();
    assert_eq!(
        again.attributes.labels.as_ref().unwrap().materials,
        shining.attributes.labels.as_ref().unwrap().materials
    );
    assert_eq!((again.faces, again.positions), (shining.faces.clone(), shining.positions.clone()));
    assert_eq!(io::write(&at("s.obj"), &shining).unwrap(), ["the look of 2 materials: only glTF has it"]);
    // A name that another property has, and labels that are too few.
    let mut clash = soup.clone();
    clash.attributes.vertex_numbers[0].name = "x".into();
    assert!(io::write(&at("c.ply"), &clash).unwrap().iter().any(|what| what.starts_with("numbers `x`")));
    clash.attributes.labels.as_mut().unwrap().of_face.pop();
    assert!(matches!(io::write(&at("c.obj"), &clash), Err(Error::Size { .. })));
}

#[test]
fn names_and_numbers_go_through_a_repair() {
    let mut soup = labelled();
    // The second face looks the other way, and the first repeats a vertex.
    soup.faces[1].swap(0, 1);
    soup.faces[0][1] = soup.faces[0][0];
    let repaired = repair(&soup, &Repair::default(), &Control::new()).unwrap();
    let (given, found) = (&soup.attributes, &repaired.soup.attributes);
    let labels = found.labels.as_ref().unwrap();
    for (f, &origin) in repaired.face_origin.iter().enumerate() {
        let given = given.labels.as_ref().unwrap();
        assert_eq!(
            labels.labels[labels.of_face[f] as usize],
            given.labels[given.of_face[origin as usize] as usize]
        );
        assert_eq!(found.face_numbers[0].values[f], f64::from([1u8, 2, 3, 255][origin as usize]));
    }
    for (v, &origin) in repaired.vertex_origin.iter().enumerate() {
        assert_eq!(found.vertex_numbers[1].values[v], given.vertex_numbers[1].values[origin as usize]);
    }
}
