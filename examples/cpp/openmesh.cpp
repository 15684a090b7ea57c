// An OpenMesh mesh is flattened with eight cones that the library places: UVs on its corners, a factor per
// vertex, the distortion.
#include <iostream>
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <ricci/openmesh.hpp>

int main(int argc, char **argv) {
    try {
        OpenMesh::TriMesh_ArrayKernelT<> mesh;
        if (!OpenMesh::IO::read_mesh(mesh, argc > 1 ? argv[1] : "mesh.obj")) return 1;
        const ricci::metric start(ricci::openmesh::from(mesh));
        const auto flat = ricci::flow(start, ricci::target::automatic(8));
        const ricci::layout layout(flat);

        const auto uv = ricci::openmesh::uv(mesh, layout);
        const auto factor = ricci::openmesh::factor(mesh, flat);
        const auto corner = mesh.halfedge_handle(mesh.face_handle(0)); // the corner at its tip
        std::cout << flat.report().stop_reason_text << ", " << flat.cones().size() << " cones\n"
                  << "corner of face 0 at vertex " << mesh.to_vertex_handle(corner).idx() << ": "
                  << mesh.property(uv, corner) << "\n"
                  << "vertex 0: log scale " << mesh.property(factor, mesh.vertex_handle(0)) << "\n";

        const auto figures = layout.summary();
        std::cout << "dilatation " << figures.qc_mean << " (mean) " << figures.qc_max << " (max), area ratio "
                  << figures.area_ratio_min << " to " << figures.area_ratio_max << ", "
                  << figures.n_flipped_input << " faces fold\n";
        return flat.report().converged && figures.n_flipped == 0 ? 0 : 1;
    } catch (const ricci::error &error) {
        std::cerr << ricci_status_text(error.status()) << ": " << error.what() << "\n";
        return 1;
    }
}
