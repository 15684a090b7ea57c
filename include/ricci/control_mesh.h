/* ricci: splines over control meshes of Catmull-Clark surfaces.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_quad_spline_fit_quads(&control_mesh, NULL, NULL, &spline);
 *     ricci_quad_spline_write_step(spline, NULL, "part.step");
 *
 * The conventions are those of ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: the surface [CC78], its points [HKD93].
 */

#ifndef RICCI_CONTROL_MESH_H
#define RICCI_CONTROL_MESH_H

#include <ricci/quad_spline.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A connected mesh of quadrilaterals as the control mesh of a Catmull-Clark surface. */
typedef struct ricci_control_mesh {
    /** sizeof(ricci_control_mesh), by ricci_init. */
    size_t size;
    /** n_vertices points: x, y, z; finite. */
    const double *positions;
    /** Number of vertices; each is a corner of a quadrilateral. */
    size_t n_vertices;
    /** n_quads x 4 vertex indices, 0-based, counterclockwise seen from outside. */
    const uint32_t *quads;
    /** Number of quadrilaterals, at least 1. */
    size_t n_quads;
} ricci_control_mesh;

/**
 * A spline near the Catmull-Clark surface of a control mesh, whose patches lie between the lines of edges
 * that go straight on from irregular vertices. They have one span for each quadrilateral, up to 32: where no
 * irregular vertex is near, the surface is such a spline. The boundary is a cubic spline through the corners.
 *
 * Deterministic.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (bending, spans; a negative index),
 *         RICCI_SPLINE (a quadrilateral or a vertex that makes the mesh no surface, with its number),
 *         RICCI_CONNECTIVITY (several parts), RICCI_LAYOUT (no division into four-sided patches),
 *         RICCI_TOO_LARGE, RICCI_NO_MEMORY, RICCI_FACTORISATION, RICCI_CANCELLED.
 *
 * @param control_mesh  the control mesh.
 * @param options       the options; NULL for the defaults; bending 0 is 1e-11 here.
 * @param control       progress and cancellation, or NULL.
 * @param spline        out: the new handle, to be released by ricci_quad_spline_free.
 */
RICCI_API RICCI_EXPERIMENTAL ricci_status
ricci_quad_spline_fit_quads(const ricci_control_mesh *control_mesh, const ricci_quad_spline_options *options,
                            const ricci_control *control, ricci_quad_spline **spline);

#ifdef __cplusplus
}
#endif

#endif
