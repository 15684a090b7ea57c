//! `ricci harmonic`: maps to a disk, a rectangle, the sphere, and with values from a file.

use crate::run::{Place, numbers};

#[test]
fn disks_go_to_the_disk_and_the_rectangle() {
    let place = Place::new();
    place.expect(0, "make disk -o d.obj");
    place.expect(0, "harmonic d.obj --uv flat.obj --picture flat.svg --report r.json");
    assert_eq!(place.json("r.json")["result"]["flipped_triangles"].as_u64(), Some(0));
    let radius = |line: &str| {
        let uv: Vec<f64> = line.split(' ').skip(1).map(|x| x.parse().unwrap()).collect();
        uv[0].hypot(uv[1])
    };
    let text = place.text("flat.obj");
    let radii: Vec<f64> = text.lines().filter(|l| l.starts_with("vt ")).map(radius).collect();
    assert!(radii.iter().all(|r| *r < 1.0 + 1e-12) && radii.iter().any(|r| *r > 1.0 - 1e-12));
    place.expect(0, "harmonic d.obj --to rectangle --report r.json");
    let corners = numbers(&place.json("r.json")["result"]["corners"]);
    let line = corners.iter().map(ToString::to_string).collect::<Vec<_>>().join(",");
    place.expect(0, &format!("harmonic d.obj --to rectangle --corners {line}"));
    assert!(place.expect(2, "harmonic d.obj --corners 1,2,3").err.contains("--corners"));
    assert!(place.expect(2, "harmonic d.obj --sphere s.obj").err.contains("--to sphere"));
}

#[test]
fn disks_go_to_polygons() {
    let place = Place::new();
    place.expect(0, "make disk -n 8 --height 0.4 -o d.obj");
    place.expect(0, "harmonic d.obj --to polygon:5 --uv flat.obj --report r.json");
    let report = place.json("r.json");
    assert_eq!(report["checks"]["flipped_triangles"]["value"].as_f64(), Some(0.0));
    assert_eq!(report["options"]["to"]["polygon"].as_u64(), Some(5));
    let corners = numbers(&report["result"]["corners"]);
    let line = corners.iter().map(ToString::to_string).collect::<Vec<_>>().join(",");
    place.expect(0, &format!("harmonic d.obj --to polygon --corners {line} --uv named.obj"));
    assert_eq!(place.text("flat.obj"), place.text("named.obj"));
    assert!(place.expect(2, "harmonic d.obj --to polygon").err.contains("polygon:N"));
    assert!(place.expect(2, "harmonic d.obj --to polygon:2").err.contains("at least 3"));
    assert!(place.expect(2, "harmonic d.obj --to polygon:4 --corners 1,2,3").err.contains("4 corners"));
    place.expect(2, "harmonic d.obj --to polygon --corners 0,1,2");
    for many in ["1000", "4294967295"] {
        let refused = place.expect(2, &format!("harmonic d.obj --to polygon:{many}"));
        assert!(refused.err.contains(&format!("number of corners is {many}")), "{}", refused.err);
    }
}

#[test]
fn spheres_go_to_the_sphere() {
    let place = Place::new();
    place.expect(0, "make ellipsoid -n 5 -o e.obj");
    place.expect(0, "harmonic e.obj --sphere s.obj --report r.json");
    let report = place.json("r.json");
    let energies = numbers(&report["result"]["energies"]);
    assert!(energies.windows(2).all(|pair| pair[1] <= pair[0]));
    for line in place.text("s.obj").lines().filter(|l| l.starts_with("v ")) {
        let square: f64 = line.split(' ').skip(1).map(|x| x.parse::<f64>().unwrap().powi(2)).sum();
        assert!((square - 1.0).abs() < 1e-14);
    }
    assert!(place.expect(2, "harmonic e.obj --uv flat.obj").err.contains("--sphere"));
    place.expect(0, "make torus -o t.obj");
    assert!(place.expect(3, "harmonic t.obj").err.contains("genus 1"));
}

#[test]
fn values_come_from_a_file() {
    let place = Place::new();
    place.put(
        "d.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n",
    );
    place.put("f.csv", "vertex,x,y\n0,0,0\n1,2,0\n2,2,1\n3,0,1\n");
    place.expect(0, "harmonic d.obj --to file:f.csv --uv out.obj");
    let text = place.text("out.obj");
    let numbers = |line: &str| line.split(' ').skip(1).map(|x| x.parse().unwrap()).collect::<Vec<f64>>();
    let places: Vec<Vec<f64>> = text.lines().filter(|l| l.starts_with("vt ")).map(numbers).collect();
    assert!(places.iter().any(|p| (p[0] - 1.0).abs() < 1e-12 && (p[1] - 0.5).abs() < 1e-12), "{text}");
    place.put("far.csv", "0,1e200,0\n2,-1e200,1\n");
    assert!(place.expect(2, "harmonic d.obj --to file:far.csv").err.contains("too far apart"));
    place.put("g.csv", "0,0,0\n0,1,1\n");
    assert!(place.expect(3, "harmonic d.obj --to file:g.csv").err.contains("named twice"));
    assert!(place.expect(2, "harmonic d.obj --to moon").err.contains("disk, polygon:N"));
}

#[test]
fn the_heat_flow_falls_to_the_map_and_a_square_has_modulus_1() {
    let place = Place::new();
    place.expect(0, "make disk -n 6 --height 0.4 -o d.obj");
    place.expect(0, "harmonic d.obj --report solved.json");
    place.expect(0, "harmonic d.obj --method heat --trace t.csv --report heat.json");
    let energies: Vec<f64> = place
        .text("t.csv")
        .lines()
        .skip(1)
        .map(|row| row.split_once(',').unwrap().1.parse().unwrap())
        .collect();
    assert!(energies.len() > 20 && energies.windows(2).all(|pair| pair[1] <= pair[0] + 1e-14 * energies[0]));
    let energy = |name: &str| place.json(name)["result"]["energy"].as_f64().unwrap();
    assert!((energies[energies.len() - 1] / energy("solved.json") - 1.0).abs() < 1e-12);
    place.put("q.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
    let square = place.expect(0, "harmonic q.obj --to rectangle --corners 0,1,2,3 --report r.json");
    assert!((place.json("r.json")["result"]["modulus"].as_f64().unwrap() - 1.0).abs() < 1e-14);
    assert!(square.out.contains("modulus"), "{}", square.out);
    assert!(place.expect(2, "harmonic d.obj --to rectangle --method heat").err.contains("linear"));
    assert!(place.expect(2, "harmonic d.obj --trace t.csv").err.contains("--method heat"));
}
