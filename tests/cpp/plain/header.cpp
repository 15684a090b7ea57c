// The headers are clean C++; handles free themselves, failures throw with status, element, amount and
// message.
#include "brain_files.hpp"
#include <ricci/archive.hpp>
#include <ricci/bicubic.hpp>
#include <ricci/circles.hpp>
#include <ricci/flatten.hpp>
#include <ricci/harmonic.hpp>
#include <ricci/match.hpp>
#include <ricci/moduli.hpp>
#include <ricci/quad_spline.hpp>
#include <ricci/quads.hpp>
#include <ricci/repair.hpp>
#include <ricci/scene.hpp>
#include <ricci/spline.hpp>
#include <ricci/structure.hpp>
#include <ricci/texture.hpp>
#include <ricci/uniformize.hpp>

#include <algorithm>
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
    if (layout.uv().size() != 24 || layout.distortion().first.size() != 4) return 4;
    if (layout.distortion(RICCI_ON_REFINEMENT).second.size() != summary.n_faces) return 4;
    if (layout.seam_edges().size() != summary.n_seams || !layout.flipped().empty()) return 5;
    // A closed surface is cut along sides of seams alone.
    const std::vector<std::int32_t> lines = layout.lines(0.5);
    std::size_t n_points = 0;
    for (std::size_t k = 0; k < lines.size(); k += 4) n_points += static_cast<std::size_t>(lines[k + 3]);
    if (lines.empty() || lines[0] != RICCI_LAYER_SEAMS) return 10;
    if (layout.line_points(0.5).size() != n_points) return 10;
    const ricci::map map(end);
    if (map.faces(RICCI_ON_INPUT).size() != map.summary().n_faces) return 6;
    if (ricci::charts(layout).faces().size() != summary.n_faces) return 7;
    const ricci::repaired_input repaired(layout);
    if (repaired.summary().n_flipped != 0 || repaired.faces().size() != repaired.summary().n_faces) return 7;
    ricci::metric moved = std::move(start);
    if (start || !moved) return 8; // NOLINT: what was moved from is empty
    ricci::solver solver(moved);
    const std::vector<std::uint32_t> twice = {0, 0, 1};
    const bool defects = ricci::soup::from(positions, twice).summary().n_defects > 0;
    return defects && solver.solve(target).report().converged == 1 ? 0 : 9;
}

// What is kept comes back as it was, with what it was made from.
int archives() {
    const auto mesh = ricci::mesh::from(positions, faces);
    const ricci::metric end = ricci::flow(
        ricci::metric(mesh), ricci::target::given(std::vector<double>(4, 3.14159265358979323846)));
    const ricci::archive kept(end);
    const ricci::archive same = ricci::archive::parse(kept.bytes());
    const auto again = same.get_as<ricci::metric>();
    if (again.lengths() != end.lengths() || ricci::archive(again).bytes() != kept.bytes()) return 61;
    if (same.get_as<ricci::mesh>().positions() != positions) return 62;
    try {
        same.get_as<ricci::layout>();
        return 63;
    } catch (const std::invalid_argument &) {
        return 0;
    }
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
    ricci_deck_spec shortest = ricci::init<ricci_deck_spec>();
    shortest.kind = RICCI_DECK_GEODESICS, shortest.radius = 3.1, shortest.limit = 100000;
    const auto systoles = bolza.deck(shortest);
    const auto line = systoles.geodesic(0);
    if (systoles.summary().n_elements != 12 || line.second.size() != 3 * line.first.size()) return 14;
    if (ricci::fenchel_nielsen(bolza).size() != 6) return 14;
    if (ricci::n_pants_curves(2, 4) != 3 || ricci::n_pants_curves(0, 2) != 0) return 14;
    const auto basis = bolza.homotopy();
    const auto loops = basis.loops();
    std::size_t edges = 0;
    for (std::size_t k = 0; k < loops.size(); k++) edges += loops[k].size();
    const std::vector<std::int32_t> none = {1, 2, -2, -1};
    return edges == basis.summary().n_loop_edges && basis.reduced(none).empty() ? 0 : 15;
}

// A ball on the sphere, inflated, and without a part of it.
int cortices() {
    ricci_shape shape = ricci::init<ricci_shape>();
    shape.shape = RICCI_SHAPE_SPHERE, shape.n = 4;
    const auto ball = ricci::mesh::made(shape);
    const std::size_t n = ball.summary().n_vertices;
    const auto round = ricci::flatten_sphere(ball);
    const auto view = ricci::inflate(ball);
    auto marks = ricci::medial_wall(ball, view, {1, 0, 0}, 0.2);
    for (auto &mark : marks) mark = 1 - mark;
    const auto part = ricci::flat_part(ball, marks);
    return round.points.size() == 3 * n && view.size() == 3 * n && part == marks ? 0 : 23;
}

// Forms with the periods of the flat torus of i, a map of a disk, and an annulus between circles.
int forms_and_maps() {
    ricci_shape shape = ricci::init<ricci_shape>();
    shape.shape = RICCI_SHAPE_DISK, shape.n = 5;
    const auto disk = ricci::mesh::made(shape);
    const auto unrolled = ricci::flatten(disk);
    const auto strained = ricci::flatten_strains(disk, unrolled.points);
    const auto opened = ricci::flatten_darts(disk);
    if (strained.size() != 3 * disk.summary().n_faces || opened.summary.n_darts != 0) return 22;
    if (unrolled.points.size() != 2 * disk.summary().n_vertices ||
        unrolled.energies.size() != unrolled.summary.n_energies ||
        unrolled.summary.after[RICCI_DISTORTION_MAX_LENGTH_ERROR] > 1e-12)
        return 35;
    const std::vector<double> round = ricci::harmonic(disk);
    double farthest = 0;
    for (std::size_t v = 0; v + 2 < round.size(); v += 3)
        farthest = std::max(farthest, std::hypot(round[v], round[v + 1]));
    if (round.size() != 3 * disk.summary().n_vertices || std::abs(farthest - 1) > 1e-12) return 31;
    const ricci::matching matching(disk, disk);
    if (matching.faces().size() != disk.summary().n_vertices || matching.summary().n_flipped != 0 ||
        matching.weights(RICCI_MATCH_BACKWARD).size() != round.size())
        return 34;
    ricci_shape tube = ricci::init<ricci_shape>();
    tube.shape = RICCI_SHAPE_TORUS, tube.n = 12, tube.m = 8, tube.a = 2, tube.b = 0.8;
    const auto torus = ricci::mesh::made(tube);
    const auto own = ricci::homotopy(torus).loops();
    const ricci::match_basis basis(own, own);
    const std::uint32_t met[] = {3, 3}, soft[] = {40, 60};
    const double weights[] = {1, 0, 0, 1, 0, 0}, one = 1;
    ricci_match_options options = ricci::init<ricci_match_options>();
    basis.name(options);
    options.point_faces = met, options.point_weights = weights, options.n_points = 1;
    options.soft = soft, options.soft_weights = &one, options.n_soft = 1;
    const ricci::matching marked(torus, torus, options);
    if (marked.summary().n_markings != 1 || marked.soft_left().size() != 1 || marked.soft_left()[0] <= 0 ||
        marked.points().size() != 1 || marked.points()[0][1].face != 3)
        return 36;
    const std::uint32_t own_places[] = {3, 3};
    ricci_match_options held = ricci::init<ricci_match_options>();
    held.landmarks = own_places, held.n_landmarks = 1;
    const ricci::matching met_there(torus, torus, held);
    if (met_there.landmarks().size() != 1 || met_there.landmarks()[0][1] != 3 ||
        !met_there.landmarks(RICCI_LANDMARKS_KEPT).empty() || met_there.found().has_kept != 0)
        return 36;
    const std::vector<std::uint32_t> at = {0, 1};
    const std::vector<double> places = {0, 0, 2, 0, 0, 2};
    for (std::size_t v = 0; v < round.size() / 3; v++)
        if (std::abs(ricci::harmonic(disk, at, places)[3 * v + 2] - 2) > 1e-9) return 32;
    shape.shape = RICCI_SHAPE_GENUS, shape.n = 4, shape.genus = 2;
    const ricci::forms forms(ricci::mesh::made(shape));
    const auto figures = forms.summary();
    if (figures.n_forms != 4 || forms.periods().size() != 8 || figures.least_eigenvalue <= 0) return 33;
    const ricci::period_bounds bounds(forms);
    if (bounds.summary.gap > 1e-3 || bounds.genus != 2 || bounds.at(1, 1).imaginary <= 0) return 33;
    if (std::abs(bounds.at(0, 1).real - bounds.at(1, 0).real) > 0 || bounds.at(0, 0).radius <= 0) return 33;
    const std::vector<double> first = {1, 0, 0, 0};
    const auto real = forms.values(0), both = forms.holomorphic(first);
    if (both.size() != 2 * real.size() || both[0] != real[0]) return 34;
    std::int64_t zeros = 0;
    for (const ricci::zero &zero : forms.zeros(first)) zeros += zero.multiplicity;
    if (zeros != 2 || forms.triangulation().summary().n_edges != figures.n_edges) return 35;
    shape = ricci::init<ricci_shape>();
    shape.shape = RICCI_SHAPE_ANNULUS, shape.n = 2, shape.m = 24, shape.a = 0.5, shape.b = 1;
    const ricci::circle_domain ring(ricci::mesh::made(shape));
    const auto circles = ring.circles();
    return circles.size() == 8 && ring.summary().converged == 1 && ring.layout().summary().n_flipped == 0 &&
                   ring.mesh().summary().n_vertices >= 72
               ? 0
               : 36;
}

// The projective structure of a surface of genus 2.
int structures() {
    ricci_shape shape = ricci::init<ricci_shape>();
    shape.shape = RICCI_SHAPE_GENUS, shape.n = 4, shape.genus = 2;
    const ricci::structure atlas(ricci::mesh::made(shape), RICCI_STRUCTURE_PROJECTIVE);
    const auto all = atlas.summary();
    const auto places = atlas.places(0, {{0.5, 0.25, 0.25}});
    if (places.size() != 3 || atlas.holonomy().size() != 9 * all.n_generators) return 37;
    const auto moved = atlas.carry(places[0], places[1], places[0].coordinates);
    if (std::hypot(moved[0] - places[1].coordinates[0], moved[1] - places[1].coordinates[1]) > 1e-11)
        return 38;
    const auto joined = atlas.transitions();
    if (joined.charts.size() != 2 * all.n_transitions || joined.matrices.size() != 9 * all.n_transitions)
        return 39;
    if (atlas.rows(RICCI_CHART_VERTICES)[0].size() * 2 != atlas.coordinates(0).size() ||
        atlas.rows(RICCI_TRANSITION_PAIRS).size() != all.n_transitions ||
        !atlas.list(RICCI_STRUCTURE_SINGULAR).empty())
        return 40;
    return 0;
}

// Quads of a torus and its layout of patches.
int quads() {
    ricci_shape shape = ricci::init<ricci_shape>();
    shape.shape = RICCI_SHAPE_TORUS, shape.n = 16, shape.m = 10, shape.a = 2, shape.b = 1;
    const ricci::seamless flat(ricci::mesh::made(shape));
    ricci_flatten_summary told;
    const ricci::layout least = flat.flatten(ricci::init<ricci_flatten_options>(), &told);
    if (told.stop != RICCI_FLATTEN_CONVERGED || told.n_energies < 2 || least.summary().n_flipped) return 52;
    const ricci::quads few(flat, ricci::quads_of_number(200)), fine(flat, ricci::quads_of_edge(0.4));
    const auto all = few.summary();
    if (all.euler != 0 || all.n_bad_edges + all.n_bad_vertices != 0) return 53;
    if (few.faces().size() != 4 * all.n_quads || few.positions().size() != 3 * all.n_vertices) return 53;
    if (few.places().second.size() != 3 * all.n_vertices || few.rectangles().size() != all.n_quads) return 54;
    if (!few.creases().empty() || fine.summary().n_quads <= all.n_quads) return 54;
    const ricci::quad_layout layout(flat);
    const auto counts = layout.summary();
    const auto sides = layout.sides();
    const auto sizes = layout.sizes(), arcs = layout.arcs(), patches = layout.patches();
    if (counts.n_nodes + counts.n_patches != counts.n_arcs || sides.size() != 4 * counts.n_patches) return 55;
    for (std::size_t side = 0; side < sides.size(); side++) {
        std::uint32_t length = 0;
        for (std::int32_t a : sides[side]) length += arcs[4 * static_cast<std::size_t>(std::abs(a) - 1) + 2];
        if (length != sizes[2 * (side / 4) + side % 2]) return 56;
    }
    const auto along = layout.arc_vertices();
    for (std::size_t a = 0; a < along.size(); a++)
        if (along[a].size() != counts.n_parts * arcs[4 * a + 2] + 1) return 57;
    if (layout.nodes().size() != 3 * counts.n_nodes) return 58;
    return layout.quads().summary().n_quads == patches.size() ? 0 : 58;
}

// A spline over the patches of an ellipsoid.
int quad_splines() {
    ricci_shape shape = ricci::init<ricci_shape>();
    shape.shape = RICCI_SHAPE_ELLIPSOID, shape.n = 5, shape.a = 1.6, shape.b = 1.2, shape.c = 1;
    const ricci::mesh mesh = ricci::mesh::made(shape);
    const ricci::seamless flat(mesh);
    ricci_quad_spline_options options = ricci::init<ricci_quad_spline_options>();
    options.most_spans = 1;
    const ricci::quad_spline spline(flat, options), same(flat, ricci::quad_layout(flat), options);
    const auto all = spline.summary();
    const auto patch = spline.patch(0);
    const auto poles = spline.poles(0);
    if (all.n_folded_patches != spline.folds().size() || same.poles(0) != poles) return 70;
    if (poles.size() != 3 * patch.n_poles[0] * patch.n_poles[1]) return 71;
    if (spline.controls(0).size() * 3 != poles.size()) return 71;
    const auto knots = spline.knots(0, RICCI_ALONG_V);
    if (knots.knots.size() != patch.n_knots[1] || knots.multiplicities[0] != 6) return 72;
    if (spline.bezier(0, RICCI_ALONG_V).size() != 36 * (knots.knots.size() - 1)) return 72;
    const auto arc = spline.arc(patch.arcs[0]);
    if (spline.arc_poles(patch.arcs[0]).size() != 3 * arc.n_poles) return 73;
    const std::vector<std::uint32_t> on = {0, 1};
    const std::vector<double> at = {0.25, 0.5, 0.75, 0.5};
    const auto points = spline.evaluate(on, at);
    const auto found = spline.closest(points);
    if (found.patches != on || found.values[5] > 1e-10 || found.values[11] > 1e-10) return 74;
    if (spline.tessellated(3).summary().n_faces != 18 * all.n_patches) return 75;
    if (spline.tessellated_within(0.01).summary().euler != 2) return 76;
    if (spline.patch_of_faces(mesh).size() != mesh.summary().n_faces) return 77;
    const auto matrix = spline.extraction();
    if (matrix.starts.back() != matrix.values.size() || matrix.columns.size() != all.n_entries) return 78;
    spline.write_step("quad_spline_cxx.step");
    const std::vector<std::uint32_t> square = {0, 1, 2, 3};
    const std::vector<double> places = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    auto one = ricci::init<ricci_control_mesh>();
    one.positions = places.data(), one.n_vertices = 4, one.quads = square.data(), one.n_quads = 1;
    const ricci::quad_spline plate(one);
    if (plate.summary().n_patches != 1 || !std::isnan(plate.summary().volume)) return 110;
    plate.write_json("quad_spline_cxx.json");
    try {
        spline.patch(all.n_patches);
        return 79;
    } catch (const ricci::error &error) {
        return error.status() == RICCI_SPLINE ? 0 : 80;
    }
}

// A spline of a parabola over a square with a hole.
int splines() {
    const std::vector<double> outer = {0, 0, 2, 0, 2, 2, 0, 2};
    ricci::lists<double> both;
    both.entries = {0, 0, 2, 0, 2, 2, 0, 2, 0.8, 0.8, 1.2, 0.8, 1, 1.2}, both.starts = {0, 8, 14};
    const ricci::spline flat(ricci::spline_domain(both, 0.4), 2);
    const std::vector<double> terms = {0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0, 0, 0, 0, 0, 0.5};
    const ricci::spline bowl = flat.with_polynomial(terms);
    const std::vector<double> places = {0.3, 0.4, 1.7, 0.2}, middle = {1, 1, 0.3, 0.4};
    const std::vector<std::int32_t> patches = bowl.locate(middle);
    if (patches[0] != -1 || patches[1] < 0) return 41;
    const std::vector<double> points = bowl.evaluate(places),
                              jets = bowl.evaluate(places, RICCI_SPLINE_SECOND);
    if (points.size() != 6 || jets.size() != 36 || std::abs(points[2] - 1.125) > 1e-13) return 42;
    const std::vector<std::uint32_t> patch = {static_cast<std::uint32_t>(patches[1])};
    const std::vector<double> there = {0.3, 0.4}, twice = {0.3, 0.4, 0.3, 0.4};
    if (bowl.evaluate(patch, there)[2] != points[2]) return 43;
    if (std::abs(bowl.blossom(patch[0], twice)[2] - 1.125) > 1e-12) return 44;
    const auto again = ricci::spline::parse(bowl.text());
    if (again.control_points() != bowl.control_points() || again.knots() != bowl.knots()) return 45;
    if (again.controls().size() != 6 * bowl.summary().n_patches) return 46;
    bowl.write("bowl.json");
    if (ricci::spline::read("bowl.json").text() != bowl.text()) return 47;
    std::vector<double> samples;
    for (double x = 0; x < 2.01; x += 0.125)
        for (double y = 0; y < 0.7; y += 0.125) samples.insert(samples.end(), {x, y, x * y});
    if (flat.fitted(samples).summary().fit_max > 1e-6) return 48;
    if (flat.with_points(bowl.control_points()).text() != bowl.text()) return 49;
    if (bowl.tessellated(2).summary().n_faces != 4 * bowl.summary().n_patches) return 50;
    try {
        const ricci::spline none(ricci::spline_domain(outer, 0.5), 6);
        return 51;
    } catch (const ricci::error &error) {
        return error.status() == RICCI_ARGUMENT && std::strstr(error.what(), "degree") ? 0 : 52;
    }
}

// Its patches for CAD.
int bicubic_patches() {
    const std::vector<double> outer = {0, 0, 2, 0, 2, 2, 0, 2};
    const ricci::spline flat(ricci::spline_domain(outer, 1.5), 3);
    const ricci::bicubic patches(flat);
    const ricci_bicubic_summary figures = patches.summary();
    if (figures.n_patches != 3 * flat.summary().n_patches || figures.closed || figures.n_open_sides)
        return 61;
    ricci_step_options options = ricci::init<ricci_step_options>();
    options.name = "square", options.unit = RICCI_UNIT_METRE;
    const std::string text = patches.text(RICCI_BICUBIC_STEP, options);
    if (text.find("ISO-10303-21;") != 0 || text.find("'square'") == std::string::npos) return 62;
    if (text == patches.text() || patches.text(RICCI_BICUBIC_JSON)[0] != '{') return 63;
    patches.write("square.step", options);
    try {
        ricci_bicubic_options wrong = ricci::init<ricci_bicubic_options>();
        wrong.tolerance = -1;
        const ricci::bicubic none(flat, wrong);
        return 64;
    } catch (const ricci::error &error) {
        return error.status() == RICCI_ARGUMENT && std::strstr(error.what(), "tolerance") ? 0 : 65;
    }
}

// A roof of two squares, given as polygons, unfolds into one chart.
int texture_atlases() {
    ricci::lists<std::uint32_t> squares;
    squares.entries = {0, 1, 2, 3, 3, 2, 4, 5}, squares.starts = {0, 4, 8};
    const std::vector<double> roof = {0, 0, 0, 1, 0, 0, 1, 1, 1, 0, 1, 1, 1, 2, 0, 0, 2, 0};
    const ricci::soup model = ricci::soup_of_polygons(roof, squares);
    if (ricci::polygons_of(model) != std::vector<std::uint32_t>{0, 0, 1, 1}) return 120;
    auto options = ricci::init<ricci_texture_options>();
    options.page = 64;
    const ricci::texture_atlas atlas(model, options);
    const auto split = atlas.split();
    if (atlas.summary().n_charts != 1 || atlas.charts() != std::vector<std::uint32_t>(4, 0)) return 121;
    if (split.vertices.size() != 6 || split.uv.size() != 12 || split.faces.size() != 4) return 122;
    if (!atlas.faces(RICCI_TEXTURE_FOLDED).empty() || split.corners.size() != 12) return 123;
    if (atlas.textured().values(RICCI_UV) != atlas.uv()) return 124;
    options.page = 100;
    try {
        const ricci::texture_atlas none(model, options);
        return 125;
    } catch (const ricci::error &error) {
        return error.status() == RICCI_ARGUMENT ? 0 : 126;
    }
}

// A scene of one square stays a scene.
int scenes() {
    ricci::mesh::from(positions, faces).write("square.glb");
    const ricci::scene scene("square.glb");
    if (scene.summary().n_meshes != 1) return 130;
    auto page = ricci::init<ricci_texture_options>();
    page.page = 64;
    auto options = ricci::init<ricci_scene_options>();
    options.texcoord = 1;
    const auto report = scene.write(scene.atlas(page), "square_atlas.glb", options);
    return report.texcoord == 1 && report.n_vertices == scene.summary().n_vertices ? 0 : 131;
}

int failures() {
    const ricci::control stopped;
    stopped.set_part(0, 0.5);
    stopped.cancel();
    try {
        const ricci::control_scope used(stopped);
        ricci::mesh::read("no such file.obj");
        return 24;
    } catch (const ricci::error &error) {
        if (error.status() != RICCI_CANCELLED) return 25;
    }
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
    for (int failed : {whole_job(), archives(), uniformization(), forms_and_maps(), cortices(), brain_files(),
                       gifti_files(), structures(), splines(), quads(), quad_splines(), bicubic_patches(),
                       texture_atlases(), scenes(), failures()})
        if (failed) return failed;
    return 0;
}
