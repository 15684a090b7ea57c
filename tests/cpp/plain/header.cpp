// The headers are clean C++; handles free themselves, failures throw with status, element, amount and
// message.
#include <ricci/ricci.hpp>

#include <cmath>
#include <cstring>
#include <vector>

namespace {

const std::vector<double> positions = {0, 0, 0, 1, 0, 0, 0, 1.2, 0, 0, 0.3, 0.9};
const std::vector<int> faces = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};

// A tetrahedron whose four corners become cones of pi: the flat metric of the regular one.
int whole_job() {
    const auto mesh = ricci::mesh::from(positions, faces);
    const auto counts = mesh.summary();
    if (counts.euler != 2 || counts.n_edges != 6 || mesh.positions() != positions ||
        mesh.faces().size() != 12)
        return 1;
    ricci::metric start(mesh, RICCI_SCHEME_TANGENTIAL);
    const auto target = ricci::target::given(std::vector<double>(4, 3.14159265358979323846));
    const ricci::metric end = ricci::flow(start, target);
    if (end.report().converged != 1 || end.cones().size() != 4 || start.resolve(target).size() != 4) return 2;
    const std::vector<double> lengths = end.lengths();
    for (double l : lengths)
        if (std::abs(l / lengths[0] - 1) > 1e-9) return 3;
    const ricci::layout layout(end);
    const auto summary = layout.summary();
    if (layout.uv().size() != 24 || layout.distortion().first.size() != summary.n_faces) return 4;
    if (layout.seam_edges().size() != summary.n_seams || !layout.flipped().empty()) return 5;
    const ricci::map map(end);
    if (map.faces(RICCI_ON_INPUT).size() != map.summary().n_faces) return 6;
    if (ricci::atlas(layout).faces().size() != summary.n_faces) return 7;
    ricci::metric moved = std::move(start);
    if (start || !moved) return 8; // NOLINT: what was moved from is empty
    ricci::solver solver(moved);
    const std::vector<std::uint32_t> twice = {0, 0, 1};
    const bool defects = ricci::soup::from(positions, twice).summary().n_defects > 0;
    return defects && solver.solve(target).report().converged == 1 ? 0 : 9;
}

// One class for every closed surface; words and loops as lists.
int uniformization() {
    ricci_shape shape = ricci::init<ricci_shape>();
    shape.shape = RICCI_SHAPE_SPHERE, shape.n = 2;
    const ricci::uniform ball(ricci::mesh::made(shape));
    if (ball.summary().space != RICCI_SPACE_S2 || ball.summary().converged != 1 ||
        ball.sphere_points().size() != 126)
        return 11;
    shape.shape = RICCI_SHAPE_BOLZA, shape.n = 1;
    const std::uint32_t base = 0;
    ricci_uniform_options options = ricci::init<ricci_uniform_options>();
    options.base = &base;
    const ricci::uniform bolza(ricci::mesh::made(shape), options);
    if (bolza.summary().genus != 2) return 12;
    const auto octagon = bolza.dirichlet();
    ricci_deck_spec spec = ricci::init<ricci_deck_spec>();
    spec.kind = RICCI_DECK_DIRICHLET_SIDES, spec.dirichlet = octagon.get();
    const auto sides = bolza.deck(spec);
    const auto words = sides.words();
    if (words.size() != 8 || words[0].empty() || octagon.corners().size() != 24) return 13;
    for (double trace : sides.values(RICCI_DECK_TRACE))
        if (std::abs(trace - 2 * (1 + std::sqrt(2.0))) > 1e-9) return 14;
    const auto basis = bolza.homotopy();
    const auto loops = basis.loops();
    std::size_t edges = 0;
    for (std::size_t k = 0; k < loops.size(); k++) edges += loops[k].size();
    const std::vector<std::int32_t> none = {1, 2, -2, -1};
    return edges == basis.summary().n_loop_edges && basis.reduced(none).empty() ? 0 : 15;
}

int failures() {
    try {
        ricci::mesh::read("no such file.obj");
        return 21;
    } catch (const ricci::error &error) {
        if (error.status() != RICCI_IO || !std::strstr(error.what(), "no such file.obj") ||
            error.index() != -1)
            return 22;
    }
    try {
        const ricci::metric start(ricci::mesh::from(positions, faces));
        start.resolve(ricci::target::cones(std::vector<std::uint32_t>{2}, std::vector<double>{7}));
        return 23;
    } catch (const ricci::error &error) {
        const bool told = error.status() == RICCI_TARGET_AT_VERTEX && error.element() == RICCI_ELEMENT_VERTEX;
        return told && error.index() == 2 && std::abs(error.amount() - (7 - 8 * std::atan(1.0))) < 1e-12 ? 0
                                                                                                         : 24;
    }
}

} // namespace

int main() {
    for (int failed : {whole_job(), uniformization(), failures()})
        if (failed) return failed;
    return 0;
}
