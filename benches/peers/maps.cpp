// CGAL's maps of a disk to the plane: seconds, and the images of the vertices.
//
//   maps                     what the libraries are
//   maps MESH.off METHOD OUT one of "Tutte", "conformal", "conformal LU", "LSCM": prints the seconds of the
//                            parameterisation, the mesh in memory, and writes u v of each vertex to OUT
//
// Tutte and the discrete conformal map send the boundary to the circle by its length, from the origin of the
// first half-edge of the boundary; they are solved as CGAL does by default (BiCGSTAB with incomplete LU), or
// with the sparse LU of Eigen. LSCM holds two vertices.
#include <CGAL/boost/graph/helpers.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/Barycentric_mapping_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Circular_border_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Discrete_conformal_map_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>
#include <CGAL/version.h>
#include <chrono>
#include <cstdio>
#include <Eigen/SparseLU>
#include <fstream>
#include <stdexcept>
#include <string>

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Half = boost::graph_traits<Mesh>::halfedge_descriptor;
using Images = Mesh::Property_map<Mesh::Vertex_index, Kernel::Point_2>;
namespace maps = CGAL::Surface_mesh_parameterization;
using Circle = maps::Circular_border_arc_length_parameterizer_3<Mesh>;
using Lu = CGAL::Eigen_solver_traits<Eigen::SparseLU<CGAL::Eigen_sparse_matrix<double>::EigenType>>;

template <class Method> double run(Mesh &mesh, Half border, Images images) {
    Method method;
    const auto start = std::chrono::steady_clock::now();
    const auto status = maps::parameterize(mesh, method, border, images);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (status != maps::OK) throw std::runtime_error(maps::get_error_message(status));
    return seconds.count();
}

double measure(const std::string &method, Mesh &mesh, Half border, Images images) {
    if (method == "Tutte")
        return run<maps::Barycentric_mapping_parameterizer_3<Mesh, Circle>>(mesh, border, images);
    if (method == "conformal")
        return run<maps::Discrete_conformal_map_parameterizer_3<Mesh, Circle>>(mesh, border, images);
    if (method == "conformal LU")
        return run<maps::Discrete_conformal_map_parameterizer_3<Mesh, Circle, Lu>>(mesh, border, images);
    if (method == "LSCM") return run<maps::LSCM_parameterizer_3<Mesh>>(mesh, border, images);
    throw std::runtime_error("no method " + method);
}

int main(int argc, char **argv) try {
    if (argc == 1) {
        std::printf("CGAL %s with Eigen %d.%d.%d\n", CGAL_VERSION_STR, EIGEN_WORLD_VERSION,
                    EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
        return 0;
    }
    if (argc != 4) throw std::runtime_error("usage: maps MESH.off METHOD OUT");
    Mesh mesh;
    std::ifstream in(argv[1]);
    if (!(in >> mesh) || mesh.is_empty()) throw std::runtime_error(std::string("cannot read ") + argv[1]);
    Half border = boost::graph_traits<Mesh>::null_halfedge();
    for (const Half h : mesh.halfedges())
        if (mesh.is_border(h)) {
            border = h;
            break;
        }
    if (border == boost::graph_traits<Mesh>::null_halfedge())
        throw std::runtime_error("the mesh has no boundary");
    const Images images = mesh.add_property_map<Mesh::Vertex_index, Kernel::Point_2>("v:image").first;
    std::printf("%.9f\n", measure(argv[2], mesh, border, images));
    std::ofstream out(argv[3]);
    out.precision(17);
    for (const auto v : mesh.vertices()) out << images[v].x() << ' ' << images[v].y() << '\n';
    return out.flush() ? 0 : 1;
} catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
