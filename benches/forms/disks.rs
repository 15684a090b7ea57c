//! Times of harmonic maps of disks onto the round disk, compared with CGAL's maps of the same disks.

use crate::common::peers::Program;
use crate::common::{median, seconds};
use ricci::harmonic::{Domain, planar};
use ricci::mesh::io::{Soup, read, write_off};
use ricci::mesh::shapes;
use ricci::{Control, Surface};
use std::path::{Path, PathBuf};

const ROUNDS: usize = 3;
/// CGAL's methods, by their names in benches/peers/maps.cpp.
pub const METHODS: [&str; 4] = ["Tutte", "conformal", "conformal LU", "LSCM"];
/// The method whose map is the library's on the given triangulation of the disk.
const SAME: usize = 2;
/// Open meshes of the corpus of genus 0 with one boundary loop.
const CORPUS: [&str; 3] = ["camelhead.obj", "face_libigl.obj", "cortex_human_brain_48k_open.obj"];

/// The measurements of one disk.
pub struct Disk {
    pub name: String,
    pub vertices: usize,
    /// Seconds of the intrinsic Delaunay triangulation with its weights, and of the map on it.
    pub ours: [f64; 2],
    /// Faces of that triangulation that the map turns over.
    pub flipped: usize,
    /// Per method its seconds, and the number of triangles that its map turns over.
    pub peers: Vec<(f64, usize)>,
    /// Largest distance of an image by CGAL's discrete conformal map from ours on the same triangulation, after the rotation that takes one
    /// boundary vertex to the other.
    pub difference: Option<f64>,
}

pub fn measure(sizes: &[usize], peers: Option<&Program>) -> Vec<Disk> {
    let generated = sizes.iter().map(|&n| (format!("wavy disk {n}"), wavy(n)));
    let folder = std::env::var_os("RICCI_MESHES").map(|folder| PathBuf::from(folder).join("good"));
    let corpus = folder.iter().flat_map(|folder| CORPUS.iter().map(move |name| folder.join(name)));
    let corpus = corpus.filter(|path| path.exists()).map(|path| (name(&path), read(&path).unwrap()));
    generated.chain(corpus).map(|(name, soup)| one(name, &soup, peers)).collect()
}

fn name(path: &Path) -> String {
    path.file_stem().unwrap().to_string_lossy().into_owned()
}

/// A disk of about `vertices` vertices with waves and noise.
fn wavy(vertices: usize) -> Soup {
    let mut soup = shapes::disk((vertices as f64 / 3.0).sqrt().round() as usize).unwrap();
    for p in &mut soup.positions {
        p[2] = 0.3 * (4.0 * p[0]).sin() * (3.0 * p[1]).cos();
    }
    shapes::noise(&mut soup, 0.1, 1).unwrap();
    soup
}

fn one(name: String, soup: &Soup, peers: Option<&Program>) -> Disk {
    let surface = Surface::from_soup(soup).unwrap();
    let vertices = surface.mesh().n_vertices();
    let control = Control::new();
    let file = tempfile::Builder::new().suffix(".off").tempfile().unwrap();
    write_off(file.path(), soup).unwrap();
    let (mut ours, mut theirs) = (Vec::new(), vec![Vec::new(); METHODS.len()]);
    let (mut flipped, mut difference) = (0, None);
    for round in 1..=ROUNDS {
        eprintln!("{name}, {vertices} vertices: round {round} of {ROUNDS}");
        let (prepare, domain) = seconds(|| Domain::new(&surface, &control).unwrap());
        let (solve, map) = seconds(|| planar::to_disk(&domain, &control).unwrap());
        flipped = planar::flipped(&domain, &map.points).len();
        ours.push([prepare, solve]);
        for (k, method) in METHODS.into_iter().enumerate().filter(|_| peers.is_some()) {
            let images = tempfile::NamedTempFile::new().unwrap();
            let arguments = [file.path().as_ref(), method.as_ref(), images.path().as_ref()];
            let took: f64 = peers.unwrap().run(&arguments).trim().parse().unwrap();
            let rigid = Domain::rigid(&surface).unwrap();
            let images = read_images(images.path());
            theirs[k].push((took, planar::flipped(&rigid, &images).len()));
            if k == SAME && difference.is_none() {
                let map = planar::to_disk(&rigid, &control).unwrap();
                difference = Some(distance_after_rotation(&rigid, &map.points, &images));
            }
        }
    }
    let peers = theirs.iter().filter(|all| !all.is_empty());
    let peers = peers.map(|all| (median(all.iter().map(|x| x.0)), all[0].1)).collect();
    let ours = [0, 1].map(|k| median(ours.iter().map(|x| x[k])));
    Disk { name, vertices, ours, flipped, peers, difference }
}

/// The images in the disk of radius 1 around 0: CGAL's has the radius ½ and the centre (½, ½).
fn read_images(path: &Path) -> Vec<[f64; 2]> {
    let text = std::fs::read_to_string(path).unwrap();
    let numbers: Vec<f64> = text.split_whitespace().map(|x| x.parse().unwrap()).collect();
    numbers.chunks(2).map(|z| [2.0 * z[0] - 1.0, 2.0 * z[1] - 1.0]).collect()
}

/// Largest |r f(v) − g(v)| for the rotation r that takes f to g at the first boundary vertex.
fn distance_after_rotation(domain: &Domain, f: &[[f64; 2]], g: &[[f64; 2]]) -> f64 {
    let mesh = domain.mesh();
    let first = mesh.vertices().find(|&v| mesh.is_boundary_vertex(v)).unwrap().index();
    let turn = g[first][1].atan2(g[first][0]) - f[first][1].atan2(f[first][0]);
    let (s, c) = turn.sin_cos();
    let off =
        |(f, g): (&[f64; 2], &[f64; 2])| f64::hypot(c * f[0] - s * f[1] - g[0], s * f[0] + c * f[1] - g[1]);
    f.iter().zip(g).map(off).fold(0.0, f64::max)
}
