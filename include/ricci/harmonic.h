/* ricci: harmonic maps, harmonic and holomorphic 1-forms.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_forms_new(mesh, NULL, NULL, &forms);               // 2 g harmonic forms of a closed surface
 *     ricci_forms_summarise(forms, &summary, sizeof summary);  // summary.n_forms, summary.n_edges
 *     ricci_forms_periods(forms, matrix, 2 * g * g);           // the period matrix
 *     ricci_forms_mesh(forms, &delaunay);                      // the edges that the values belong to
 *     ricci_forms_values(forms, k, values, summary.n_edges);   // form number k
 *
 * The conventions are those of ricci/ricci.h. Maps and forms live on the intrinsic Delaunay triangulation of
 * the mesh, which has its vertices.
 *
 * Sources, by the keys of docs/bibliography.md: cotangent weights [PP93], 1-forms [GY03], periods [BS16],
 * Tutte embeddings [Flo03].
 */

#ifndef RICCI_HARMONIC_H
#define RICCI_HARMONIC_H

#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A basis of the harmonic 1-forms of a surface. It never changes. */
typedef struct ricci_forms ricci_forms;

/** Classes of forms on a surface with boundary; on a closed one both are the same. */
enum {
    /** Forms that flow along the boundary. */
    RICCI_CLASSES_ABSOLUTE = 0,
    /** Forms that are 0 along the boundary. */
    RICCI_CLASSES_RELATIVE = 1
};

/** The target of a harmonic map. */
enum {
    /** A disk to the unit disk, the boundary by its length. */
    RICCI_HARMONIC_DISK = 0,
    /** A disk to the rectangle of its modulus and of height 1. */
    RICCI_HARMONIC_RECTANGLE = 1,
    /** A closed surface of genus 0 to the unit sphere, centred. */
    RICCI_HARMONIC_SPHERE = 2,
    /** Given places for some vertices. */
    RICCI_HARMONIC_VALUES = 3,
    /** A disk to the regular polygon with n corners on the unit circle, the first at (1, 0). */
    RICCI_HARMONIC_POLYGON = 4
};

/** The way to a harmonic map. */
enum {
    /** Linear solves; to the sphere, implicit steps in the metric of the image. */
    RICCI_HARMONIC_SOLVE = 0,
    /** The heat flow df/dt = Laplacian of f, whose energy falls at every step; not to the rectangle. */
    RICCI_HARMONIC_HEAT = 1
};

/** Options of ricci_forms_new; zeros are the defaults. */
typedef struct ricci_forms_options {
    /** sizeof(ricci_forms_options), by ricci_init. */
    size_t size;
    /**
     * The vertex where the loops meet; NULL: one from which they are short. Name one to compare period
     * matrices of surfaces with corresponding loops.
     */
    const uint32_t *base;
    /**
     * RICCI_CLASSES_... Flows around holes are absolute, potentials that are constant along each hole
     * relative.
     */
    uint32_t classes;
    /** 0. */
    uint32_t reserved;
} ricci_forms_options;

/** Figures of a basis of forms. */
typedef struct ricci_forms_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Number of forms: 2 genus, and with b > 0 boundary loops b - 1 more. */
    size_t n_forms;
    /** Number of edges, so of values of a form. */
    size_t n_edges;
    /** Genus of the surface. */
    size_t genus;
    /** Edge flips from the given triangulation to the Delaunay one. */
    size_t n_flips;
    /** Largest sum of a form around a face, over the form's largest value. */
    double closedness;
    /** Largest weighted sum of a form around a vertex, over the form's largest value. */
    double coclosedness;
    /** |P - P^T| / |P| of the period matrix P; NaN without one, as all below. */
    double asymmetry;
    /** |J^2 + 1| of the discrete Hodge star J. */
    double star_residual;
    /** Least eigenvalue of the imaginary part of P: positive. */
    double least_eigenvalue;
    /** Of a torus, the modulus: real and imaginary part. */
    double modulus[2];
} ricci_forms_summary;

/** A harmonic map; zeros are the defaults. */
typedef struct ricci_harmonic_spec {
    /** sizeof(ricci_harmonic_spec), by ricci_init. */
    size_t size;
    /**
     * Of RICCI_HARMONIC_VALUES: the vertices that are given, n of them. Of RICCI_HARMONIC_RECTANGLE: its four
     * corners, boundary vertices in order with the surface on the left, or none. Of RICCI_HARMONIC_POLYGON:
     * its n corners in that order; NULL: those nearest to the n-th parts of the boundary's length. NULL suits
     * boundaries without corners.
     */
    const uint32_t *vertices;
    /**
     * Of RICCI_HARMONIC_VALUES: their places, n x 3. Give the whole boundary where the image has to have a
     * shape.
     */
    const double *values;
    /** Number of vertices, and of a polygon's corners. 4 make a square. */
    size_t n;
    /**
     * RICCI_HARMONIC_DISK ... RICCI_HARMONIC_POLYGON. The disk and polygons suit maps without folds, the
     * rectangle moduli.
     */
    uint32_t target;
    /**
     * RICCI_HARMONIC_SOLVE, RICCI_HARMONIC_HEAT. Solving is the direct way; the heat flow shows the energy
     * fall.
     */
    uint32_t method;
    /**
     * Of the heat flow to the plane: length of a step, a time in units of area; 0: a hundredth of the area.
     * Smaller ones show more of the course.
     */
    double step;
    /**
     * Of the heat flow: most steps; 0: 10000, to the sphere 2000. The defaults are limits of time; the flow
     * ends as soon as the map is harmonic.
     */
    size_t max_iterations;
} ricci_harmonic_spec;

/** Figures of a harmonic map; NaN where they have no meaning. */
typedef struct ricci_harmonic_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** The energy: half of the weighted sum of squared differences along the edges. */
    double energy;
    /** Largest distance of a vertex from the mean of its neighbours, over the size of the image. */
    double mean_value_residual;
    /** Of a rectangle: its modulus, width over height. */
    double modulus;
    /** Of a rectangle: a lower bound of the modulus of the surface of flat triangles. */
    double modulus_low;
    /** Of a rectangle: an upper bound of it. */
    double modulus_high;
    /** Number of energies: that at the start, then one per step; 0 for a map that was solved for. */
    size_t n_energies;
    /** 1 if the map is harmonic within the tolerance, 0 if the steps ran out. */
    uint32_t converged;
    /** 0. */
    uint32_t reserved;
} ricci_harmonic_summary;

/**
 * The harmonic map of a surface with given boundary values, to a disk, a rectangle, a polygon or the sphere.
 *
 * On the Delaunay triangulation of a disk the maps to the unit disk and to polygons flip no triangle, unless
 * it is too thin for coordinates in double precision. Where two edges of that triangulation have the same
 * ends, or for a polygon an edge inside joins two boundary vertices, vertices are added to it, which `points`
 * leaves out.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT, RICCI_LAYOUT (a surface of
 *         another topology), RICCI_TRIANGLE_INEQUALITY, RICCI_FACTORISATION, RICCI_NO_MEMORY,
 * RICCI_CANCELLED.
 *
 * @param mesh      the surface.
 * @param spec      the target; NULL for the unit disk.
 * @param control   progress and cancellation, or NULL.
 * @param points    out: n_vertices x 3, in the plane with z = 0.
 * @param capacity  entries of `points`.
 */
RICCI_API ricci_status ricci_harmonic(const ricci_mesh *mesh, const ricci_harmonic_spec *spec,
                                      const ricci_control *control, double *points, size_t capacity);

/**
 * ricci_harmonic with the figures of the map: the modulus of a rectangle, the energies of a heat flow.
 *
 * @return as ricci_harmonic; RICCI_STRUCT_SIZE.
 *
 * @param mesh               the surface.
 * @param spec               the target and the method; NULL for the unit disk.
 * @param control            progress and cancellation, or NULL.
 * @param points             out: n_vertices x 3, in the plane with z = 0.
 * @param capacity           entries of `points`.
 * @param energies           out: the energies of the steps, as many as there is room for; NULL for none.
 * @param energies_capacity  entries of `energies`.
 * @param summary            out: the figures.
 * @param size               sizeof *summary.
 */
RICCI_API ricci_status ricci_harmonic_map(const ricci_mesh *mesh, const ricci_harmonic_spec *spec,
                                          const ricci_control *control, double *points, size_t capacity,
                                          double *energies, size_t energies_capacity,
                                          ricci_harmonic_summary *summary, size_t size);

/**
 * The harmonic 1-forms of a surface: form k has the integral 1 over loop k of a homotopy basis a1, b1, ...,
 * ag, bg, c1, ... and 0 over the others (of relative classes, beyond 2 g: over arcs between boundary loops).
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT, RICCI_LAYOUT (several components),
 *         RICCI_TRIANGLE_INEQUALITY, RICCI_FACTORISATION, RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param mesh     the surface.
 * @param options  classes and base, or NULL.
 * @param control  progress and cancellation, or NULL.
 * @param forms    out: the forms; free them with ricci_forms_free.
 */
RICCI_API ricci_status ricci_forms_new(const ricci_mesh *mesh, const ricci_forms_options *options,
                                       const ricci_control *control, ricci_forms **forms);

/**
 * Release forms.
 *
 * @param forms  the forms, or NULL.
 */
RICCI_API_VOID void ricci_forms_free(ricci_forms *forms);

/**
 * Figures of the forms.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no such size).
 *
 * @param forms    the forms.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_forms_summarise(const ricci_forms *forms, ricci_forms_summary *summary,
                                             size_t size);

/**
 * The triangulation that the forms live on, with Euclidean lengths: ricci_mesh_edges has the direction of
 * each edge.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER.
 *
 * @param forms  the forms.
 * @param mesh   out: the mesh; free it with ricci_mesh_free.
 */
RICCI_API ricci_status ricci_forms_mesh(const ricci_forms *forms, ricci_mesh **mesh);

/**
 * The integrals of a harmonic form over the edges, each in its direction.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such form).
 *
 * @param forms     the forms.
 * @param form      the number of the form, below n_forms.
 * @param values    out: n_edges values.
 * @param capacity  entries of `values`.
 */
RICCI_API ricci_status ricci_forms_values(const ricci_forms *forms, size_t form, double *values,
                                          size_t capacity);

/**
 * The holomorphic form whose real part is a combination of the harmonic forms: the combination plus i times
 * its conjugate.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_WRONG_SIZE.
 *
 * @param forms           the forms.
 * @param coefficients    a coefficient for every form.
 * @param n_coefficients  n_forms.
 * @param values          out: n_edges x 2, real and imaginary part of the integral over each edge.
 * @param capacity        entries of `values`.
 */
RICCI_API ricci_status ricci_forms_holomorphic(const ricci_forms *forms, const double *coefficients,
                                               size_t n_coefficients, double *values, size_t capacity);

/**
 * The zeros of the form of ricci_forms_holomorphic: 2 genus - 2 of them on a closed surface, with
 * multiplicity.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_WRONG_SIZE.
 *
 * @param forms           the forms.
 * @param coefficients    a coefficient for every form.
 * @param n_coefficients  n_forms.
 * @param found           out: a row for each zero: the nearest vertex, the multiplicity; NULL with capacity 0
 *                        for their number alone.
 * @param capacity        entries of `found`.
 * @param n_entries       out: number of entries, two for each zero.
 */
RICCI_API ricci_status ricci_forms_zeros(const ricci_forms *forms, const double *coefficients,
                                         size_t n_coefficients, int64_t *found, size_t capacity,
                                         size_t *n_entries);

/**
 * The period matrix of a closed surface: integrals over b_j of the holomorphic form i that has the integral 1
 * over a_i and 0 over the other a.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_LAYOUT (genus 0, or a boundary).
 *
 * @param forms     the forms.
 * @param matrix    out: genus x genus x 2, row i, column j: real and imaginary part.
 * @param capacity  entries of `matrix`.
 */
RICCI_API ricci_status ricci_forms_periods(const ricci_forms *forms, double *matrix, size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
