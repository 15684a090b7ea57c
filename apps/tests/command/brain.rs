//! `ricci brain`: the files of a hemisphere, both hemispheres, what is left alone, and what is refused.

use crate::run::Place;

/// The 32-bit words of a big-endian file from a byte on.
fn words(bytes: &[u8]) -> Vec<i32> {
    bytes.chunks_exact(4).map(|w| i32::from_be_bytes(w.try_into().unwrap())).collect()
}

/// The counts and positions of a binary surface of FreeSurfer.
fn surface(bytes: &[u8]) -> (usize, usize, Vec<f32>) {
    assert_eq!(bytes[..3], [0xff, 0xff, 0xfe]);
    let begin = bytes.windows(2).position(|pair| pair == b"\n\n").unwrap() + 2;
    let all = words(&bytes[begin..]);
    let (n, m) = (all[0] as usize, all[1] as usize);
    let places = all[2..2 + 3 * n].iter().map(|&w| f32::from_bits(w as u32)).collect();
    (n, m, places)
}

#[test]
fn both_hemispheres_get_their_files_and_are_left_alone_once_they_have_them() {
    let place = Place::new();
    place.expect(0, "make ellipsoid -n 8 -o lh.pial");
    place.expect(0, "make ellipsoid -n 6 -o rh.pial");
    let said = place.expect(0, "brain lh.pial rh.pial -o maps --gifti --pictures --report r.json");
    assert!(said.out.contains("cortex") && said.out.contains("sphere"), "{}", said.out);
    let report = place.json("r.json");
    let rows = report["result"]["hemispheres"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    for (row, side) in rows.iter().zip(["lh", "rh"]) {
        assert_eq!(row["hemisphere"].as_str(), Some(side));
        let n = row["vertices"].as_u64().unwrap() as usize;
        let (vertices, _, places) =
            surface(&std::fs::read(place.path(&format!("maps/{side}.sphere"))).unwrap());
        let (_, _, given) = surface(&std::fs::read(place.path(&format!("{side}.pial"))).unwrap());
        assert_eq!(vertices, n);
        // The sphere is turned as the surface is.
        let along = |c: usize| (0..n).map(|v| f64::from(places[3 * v + c] * given[3 * v + c])).sum::<f64>();
        assert!((0..3).all(|c| along(c) > 0.0));
        for p in places.chunks(3) {
            let length = p.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().sqrt();
            assert!((length - 100.0).abs() < 1e-4);
        }
        let cortex = row["cortex_vertices"].as_u64().unwrap() as usize;
        assert!(cortex < n && cortex > n / 2);
        let patch = words(&std::fs::read(place.path(&format!("maps/{side}.cortex.patch.flat"))).unwrap());
        assert_eq!((patch[0], patch[1] as usize, patch.len()), (-1, cortex, 2 + 4 * cortex));
        let label = place.text(&format!("maps/{side}.cortex.label"));
        assert_eq!(label.lines().nth(1), Some(&*cortex.to_string()));
        // The wall of a left hemisphere is at its right.
        let sign = if side == "lh" { 1.0 } else { -1.0 };
        let named: Vec<usize> =
            label.lines().skip(2).map(|line| line.split(' ').next().unwrap().parse().unwrap()).collect();
        let x = |v: usize| f64::from(given[3 * v]);
        let wall = (0..n).filter(|v| !named.contains(v));
        assert!(wall.map(x).all(|x| sign * x > 0.0));
        for ending in
            ["sulc", "inflated", "sphere.areal", "flat.shape", "flat.surf.gii", "cortex.label.gii", "png"]
        {
            assert!(place.path(&format!("maps/{side}.{ending}")).exists(), "{ending}");
        }
    }
    for check in ["turned_on_sphere_in_file", "turned_in_patch_in_file", "not_converged"] {
        assert_eq!(report["checks"][check]["holds"].as_bool(), Some(true), "{check}");
    }
    let time = |name: &str| place.path(name).metadata().unwrap().modified().unwrap();
    let before = time("maps/lh.sphere");
    let said = place.expect(0, "brain lh.pial rh.pial -o maps --resume");
    assert!(said.out.contains("its files are there"), "{}", said.out);
    assert_eq!(time("maps/lh.sphere"), before);
    // A file that is gone is made again.
    std::fs::remove_file(place.path("maps/rh.sulc")).unwrap();
    place.expect(0, "brain lh.pial rh.pial -o maps --resume");
    assert!(place.path("maps/rh.sulc").exists() && time("maps/lh.sphere") == before);
}

#[test]
fn a_label_is_the_cortex_and_surfaces_are_read_and_written_in_every_format_packed_or_not() {
    let place = Place::new();
    place.expect(0, "make sphere -n 8 -o ball.surf.gii");
    place.expect(0, "repair ball.surf.gii --no-weld -o ball.obj.gz");
    place.expect(0, "repair ball.obj.gz --no-weld -o lh.white");
    assert_eq!(std::fs::read(place.path("ball.obj.gz")).unwrap()[..2], [0x1f, 0x8b]);
    let (n, m, places) = surface(&std::fs::read(place.path("lh.white")).unwrap());
    let named: Vec<usize> = (0..n).filter(|&v| places[3 * v + 2] > -0.4).collect();
    let rows: String = named.iter().map(|v| format!("{v} 0 0 0 0\n")).collect();
    place.put("lh.cortex.label", &format!("#!ascii label\n{}\n{rows}", named.len()));
    place.expect(
        0,
        "brain lh.white --label lh.cortex.label -o maps --radius 1 --energy area --injective --report r.json",
    );
    let row = &place.json("r.json")["result"]["hemispheres"][0];
    assert_eq!(row["cortex_vertices"].as_u64(), Some(named.len() as u64));
    assert_eq!(row["flat"]["one_to_one"].as_bool(), Some(true));
    // A sphere stays one.
    assert!(row["sphere"]["after"]["energy"].as_f64().unwrap() - 4.0 < 1e-3 && m > 0);
}

#[test]
fn what_is_no_hemisphere_is_refused_with_the_way_out() {
    let place = Place::new();
    place.expect(0, "make sphere -n 3 -o ball.obj");
    assert!(place.expect(2, "brain ball.obj -o maps").err.contains("--hemisphere"));
    place.expect(0, "make disk -n 3 -o lh.pial");
    assert!(place.expect(3, "brain lh.pial -o maps").err.contains("1 boundary loops"));
    let said = place.expect(2, "brain ball.obj ball.obj --hemisphere left -o maps");
    assert!(said.err.contains("same names"), "{}", said.err);
    let said = place.expect(2, "brain ball.obj --hemisphere left --label a --label b -o maps");
    assert!(said.err.contains("2 labels for 1 surfaces"), "{}", said.err);
}
