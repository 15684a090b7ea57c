//! Conditions that must hold for every input that a reader accepts.

pub mod face;
pub mod surfaces;

use ricci::Error;
use ricci::control::Control;
use ricci::mesh::check::diagnose;
use ricci::mesh::io::{self, Attributes, Format, Soup};
use ricci::mesh::repair::{Repair, RepairSteps, repair};
use ricci::mesh::{Mesh, Point};
use std::path::PathBuf;
use std::sync::OnceLock;

/// True if this input is one of the few, one in `one_in`, that make long work. All of its bytes decide that, so that changed copies of such an
/// input mostly make none, and long work does not take most of the time once it is in the corpus.
pub fn is_rare(input: &[u8], one_in: u32) -> bool {
    let sum = input.iter().fold(0_u32, |sum, &b| sum.wrapping_mul(31).wrapping_add(b.into()));
    (sum ^ (sum >> 15)).is_multiple_of(one_in)
}

/// A position for a vertex on a lattice of 27 places: many are alike.
pub fn lattice(v: u32) -> Point {
    [f64::from(v % 3), f64::from(v / 3 % 3), f64::from(v / 9 % 3)]
}

/// A position for a vertex: no two alike, no three in line.
pub fn position(v: u32) -> Point {
    let t = f64::from(v);
    [t, t * t, t * t * t]
}

/// Every format that is written.
const FORMATS: [Format; 10] = [
    Format::Obj,
    Format::Off,
    Format::Ply,
    Format::Glb,
    Format::Vtk,
    Format::Vtp,
    Format::Mz3,
    Format::Gifti,
    Format::FreeSurfer,
    Format::FreeSurferText,
];

/// Bytes are refused with a place, or read into a list that holds together, builds or is diagnosed, and survives being
/// written and read again.
pub fn read(parse: impl Fn(&[u8], &str) -> ricci::Result<Soup>, bytes: &[u8]) {
    match parse(bytes, "input") {
        Ok(soup) => {
            let Soup { positions, faces, attributes } = &soup;
            let counts = [
                (attributes.normals.as_ref().map(Vec::len), positions.len()),
                (attributes.colors.as_ref().map(Vec::len), positions.len()),
                (attributes.uv.as_ref().map(Vec::len), faces.len()),
                (attributes.corner_normals.as_ref().map(Vec::len), faces.len()),
            ];
            assert!(
                counts.iter().all(|&(got, expected)| got.is_none_or(|got| got == expected)),
                "{counts:?}"
            );
            build(&soup);
            // Any byte decides.
            mend(&soup, &options(bytes.iter().fold(0, |sum, b| sum ^ b)));
            for format in FORMATS {
                round_trip(&soup, format);
            }
        }
        Err(Error::Parse { path, message, .. }) => {
            assert!(path == "input" && !message.is_empty());
        }
        Err(Error::TooLarge { .. }) => {}
        Err(other) => panic!("a reader says {other}"),
    }
}

/// The builder and the diagnosis agree.
pub fn build(soup: &Soup) {
    let diagnosis = diagnose(&soup.positions, &soup.faces);
    match Mesh::from_soup(soup) {
        Ok(mesh) => {
            assert!(diagnosis.defects.is_empty(), "{:?}", diagnosis.defects);
            mesh.validate().unwrap();
            assert_eq!((mesh.n_vertices(), mesh.n_faces()), (soup.positions.len(), soup.faces.len()));
            for (f, corners) in mesh.faces().zip(&soup.faces) {
                assert_eq!(mesh.face_vertices(f).map(|v| v.0), *corners);
            }
            counts(&mesh);
        }
        Err(Error::Defects(found)) => assert_eq!(found.defects, diagnosis.defects),
        Err(other) => panic!("{other}"),
    }
}

/// A repaired list names the origin of each element, with its attributes, has no more edges of three faces than before, and needs no
/// second repair.
pub fn mend(soup: &Soup, options: &Repair) {
    let mended = match repair(soup, options, &Control::new()) {
        Ok(mended) => mended,
        Err(Error::Argument { .. } | Error::Defects(_)) => return,
        Err(other) => panic!("{other}"),
    };
    let Soup { positions, faces, attributes } = &mended.soup;
    assert_eq!(mended.vertex_origin.len(), positions.len());
    assert_eq!(mended.face_origin.len(), faces.len());
    assert!(mended.face_origin.is_sorted_by(|a, b| a < b));
    let same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(x, y)| x.to_bits() == y.to_bits());
    for (v, &origin) in mended.vertex_origin.iter().enumerate() {
        let origin = origin as usize;
        assert!(same(&positions[v], &soup.positions[origin]));
        if let (Some(new), Some(old)) = (&attributes.normals, &soup.attributes.normals) {
            assert!(same(&new[v], &old[origin]));
        }
        if let (Some(new), Some(old)) = (&attributes.colors, &soup.attributes.colors) {
            assert!(same(&new[v], &old[origin]));
        }
    }
    let old = &soup.attributes;
    if !positions.is_empty() {
        let has = |a: &Attributes| [a.normals.is_some(), a.colors.is_some()];
        assert_eq!(has(attributes), has(old), "attributes");
    }
    if !faces.is_empty() {
        let has = |a: &Attributes| [a.corner_normals.is_some(), a.uv.is_some()];
        assert_eq!(has(attributes), has(old), "attributes of corners");
    }
    // Each face has its origin's corners, in their order or turned: the same vertices, or vertices that were welded to these.
    let tolerance = options.weld.unwrap_or(-1.0);
    let place = |v: u32| soup.positions[v as usize].map(|x| x + 0.0);
    let joined = |v: u32, w: u32| v == w || tolerance > 0.0 || tolerance == 0.0 && place(v) == place(w);
    for (f, (face, &origin)) in faces.iter().zip(&mended.face_origin).enumerate() {
        let (now, then) = (face.map(|v| mended.vertex_origin[v as usize]), soup.faces[origin as usize]);
        let corners = |order: [usize; 3]| {
            let uv = match (&attributes.uv, &old.uv) {
                (Some(new), Some(old)) => (0..3).all(|k| same(&new[f][k], &old[origin as usize][order[k]])),
                _ => true,
            };
            let normals = match (&attributes.corner_normals, &old.corner_normals) {
                (Some(new), Some(old)) => (0..3).all(|k| same(&new[f][k], &old[origin as usize][order[k]])),
                _ => true,
            };
            uv && normals && (0..3).all(|k| joined(now[k], then[order[k]]))
        };
        assert!(corners([0, 1, 2]) || corners([0, 2, 1]), "face {f}: {now:?} was {then:?}");
    }
    let crowded = |soup: &Soup| {
        let defects = diagnose(&soup.positions, &soup.faces).defects;
        defects.iter().filter(|d| matches!(d.code(), "non_manifold_edge")).count()
    };
    if options.cut_non_manifold_edges {
        assert_eq!(crowded(&mended.soup), 0);
    } else if options.weld == Some(0.0) {
        assert!(crowded(&mended.soup) <= crowded(soup));
    }
    let again = Repair { weld: None, component: None, ..options.clone() };
    let again = repair(&mended.soup, &again, &Control::new()).unwrap();
    assert!(again.soup.faces == mended.soup.faces && again.steps == RepairSteps::default(), "repaired twice");
}

/// The options of a repair that a number stands for.
pub fn options(bits: u8) -> Repair {
    Repair {
        weld: [Some(0.0), None, Some(0.5), Some(1e-300)][usize::from(bits & 3)],
        cut_non_manifold_edges: bits & 4 != 0,
        component: (bits & 8 != 0).then_some(usize::from(bits >> 4)),
        ..Repair::default()
    }
}

/// Euler's formula with the counts of the mesh.
pub fn counts(mesh: &Mesh) {
    let [v, e, f] = [mesh.n_vertices(), mesh.n_edges(), mesh.n_faces()].map(|n| n as i64);
    assert_eq!(mesh.euler(), v - e + f);
    assert_eq!(mesh.euler(), 2 - 2 * mesh.genus() as i64 - mesh.boundary_loops().len() as i64);
}

/// A list that can be written reads back with the same faces and, to what the format stores, positions.
fn round_trip(soup: &Soup, format: Format) {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder =
        FOLDER.get_or_init(|| tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).unwrap());
    let extension = match format {
        Format::Obj => "obj",
        Format::Off => "off",
        Format::Ply => "ply",
        Format::Glb => "glb",
        Format::Vtk => "vtk",
        Format::Vtp => "vtp",
        Format::Mz3 => "mz3",
        Format::Gifti => "gii",
        Format::FreeSurfer => "pial",
        Format::FreeSurferText => "asc",
    };
    let path: PathBuf = folder.path().join("m").with_extension(extension);
    match io::write_as(&path, format, soup) {
        Ok(_) => {}
        Err(Error::Argument { .. }) => return,
        Err(other) => panic!("written as {extension}: {other}"),
    }
    let back = io::read(&path).unwrap();
    if format == Format::Glb {
        survives_glb(soup, &back);
        return;
    }
    assert!(back.faces == soup.faces, "{extension}: other faces");
    if matches!(format, Format::Mz3 | Format::Gifti | Format::FreeSurfer | Format::FreeSurferText) {
        // Binary ones hold single precision, and no attributes are compared.
        let single = |x: f64| if format == Format::FreeSurferText { x } else { f64::from(x as f32) };
        let same = |(p, q): (&Point, &Point)| (0..3).all(|k| p[k] == single(q[k]));
        assert!(back.positions.iter().zip(&soup.positions).all(same), "{extension}: other positions");
        return;
    }
    // +0 and −0 are one number to a text.
    assert!(back.positions == soup.positions, "{extension}: other positions");
    survive(soup, &back, extension);
}

/// Positions are stored with 24 bits of the distance from the centre, and nothing else changes.
fn survives_glb(soup: &Soup, back: &Soup) {
    assert!(back.faces == soup.faces, "glb: other faces");
    assert_eq!(back.positions.len(), soup.positions.len());
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in &soup.positions {
        low = [0, 1, 2].map(|k| low[k].min(p[k]));
        high = [0, 1, 2].map(|k| high[k].max(p[k]));
    }
    let half = (0..3).map(|k| 0.5 * high[k] - 0.5 * low[k]).fold(0.0, f64::max);
    for (p, q) in back.positions.iter().zip(&soup.positions) {
        // And the rounding of the sum with the centre.
        let near = |k: usize| {
            let size = q[k].abs().max(low[k].abs()).max(high[k].abs());
            (p[k] - q[k]).abs() <= half * f64::from(f32::EPSILON) + 4.0 * f64::EPSILON * size
        };
        assert!((0..3).all(near), "{p:?} was {q:?}");
    }
    survive(soup, back, "glb");
}

/// Attributes that the format has come back, to its precision.
fn survive(soup: &Soup, back: &Soup, extension: &str) {
    let (old, new) = (&soup.attributes, &back.attributes);
    let (float, byte) = (f64::from(f32::EPSILON), 1.0 / 509.0);
    if let Some(old) = old.colors.as_ref().filter(|list| !list.is_empty()) {
        // Compared between 0 and 1, all that some formats can store.
        let new = new.colors.as_ref().unwrap_or_else(|| panic!("{extension}: no colours"));
        // OFF does not say whether its numbers reach to 1 or to 255; none above 1 are taken for the former.
        let dark = old.iter().flatten().all(|x| x.clamp(0.0, 1.0) * 255.0 < 1.5);
        for (new, old) in new.iter().zip(old).filter(|_| extension != "off" || !dark) {
            let near = |k: usize| (new[k].clamp(0.0, 1.0) - old[k].clamp(0.0, 1.0)).abs() <= byte;
            assert!((0..3).all(near), "{extension}: {new:?} was {old:?}");
        }
    }
    let unit = |n: Point| {
        let length = n[0].hypot(n[1]).hypot(n[2]);
        n.map(|x| x / length)
    };
    // Of any length, or of length 1.
    let parallel = |new: Point, old: Point| {
        let (new, old) = (unit(new), unit(old));
        let compared = old.iter().chain(&new).all(|x| x.is_finite());
        !compared || (0..3).all(|k| (new[k] - old[k]).abs() <= 4.0 * float)
    };
    // Of a corner: its own, or its vertex's. OBJ and GLTF have one kind, PLY and OFF that of vertices only.
    let normal = |soup: &Soup, f: usize, k: usize| match &soup.attributes {
        Attributes { corner_normals: Some(list), .. } => Some(list[f][k]),
        Attributes { normals: Some(list), .. } => Some(list[soup.faces[f][k] as usize]),
        _ => None,
    };
    if matches!(extension, "obj" | "glb") || old.corner_normals.is_none() {
        for (f, k) in (0..soup.faces.len()).flat_map(|f| [0, 1, 2].map(|k| (f, k))) {
            if let Some(old) = normal(soup, f, k) {
                let new = normal(back, f, k).unwrap_or_else(|| panic!("{extension}: no normals"));
                assert!(parallel(new, old), "{extension}: {new:?} was {old:?}");
            }
        }
    }
    if let Some(old) =
        old.uv.as_ref().filter(|list| !list.is_empty() && !matches!(extension, "off" | "vtk" | "vtp"))
    {
        let new = new.uv.as_ref().unwrap_or_else(|| panic!("{extension}: no texture coordinates"));
        for (new, old) in new.as_flattened().iter().zip(old.as_flattened()) {
            // v is stored downwards by some: 1 − v.
            let near = |k: usize| {
                (new[k] - old[k]).abs() <= 2.0 * float * (1.0 + old[k].abs())
                    || old[k].abs() > f64::from(f32::MAX)
            };
            assert!((0..2).all(near), "{extension}: {new:?} was {old:?}");
        }
    }
}
