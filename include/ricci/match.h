/* ricci: maps between two surfaces of the same topology.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *     ricci_match(source, target, NULL, NULL, &matching);
 *     ricci_matching_faces(matching, RICCI_MATCH_FORWARD, faces, n_vertices);
 *     ricci_matching_weights(matching, RICCI_MATCH_FORWARD, weights, 3 * n_vertices);
 *
 * The conventions are those of ricci/ricci.h.
 *
 * Sources, by the keys of docs/bibliography.md: maps of least energy [LWZ23; GLM19], orbifolds of landmarks
 * [AL16].
 */

#ifndef RICCI_MATCH_H
#define RICCI_MATCH_H

#include <ricci/ricci.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A map between two surfaces and its inverse. It never changes. */
typedef struct ricci_matching ricci_matching;

/** The direction of a map: from the source to the target, or back. */
enum {
    /** From the vertices of the source to the target. */
    RICCI_MATCH_FORWARD = 0,
    /** From the vertices of the target to the source. */
    RICCI_MATCH_BACKWARD = 1
};

/** The correspondence of boundaries between landmarks on them. */
enum {
    /** They slide along each other until the map is harmonic. */
    RICCI_MATCH_SLIDES = 0,
    /** By shares of their length. */
    RICCI_MATCH_ARC_LENGTH = 1
};

/** What the boundary loops of surfaces with handles become in the domain. */
enum {
    /** Geodesics of a hyperbolic metric: no map onto them folds. */
    RICCI_MATCH_GEODESICS = 0,
    /** Circles: the domain is a closed flat or hyperbolic surface with round holes. */
    RICCI_MATCH_CIRCLES = 1
};

/** What ricci_match can be asked; zeros are the defaults. */
typedef struct ricci_match_options {
    /** sizeof(ricci_match_options), by ricci_init. */
    size_t size;
    /**
     * n_landmarks x 2 vertices, of the source and of the target, that correspond: both inside, or both on
     * boundaries. Every surface takes any number of them. Eight at tips and joints suit animals in other
     * poses: in docs/results/matching.md they bring the mean error of a cat from 0.15 to 0.014 of the
     * diagonal.
     */
    const uint32_t *landmarks;
    /** Number of pairs. 0 suits surfaces in nearly the same pose. */
    size_t n_landmarks;
    /**
     * For each boundary loop of the source that of the target; NULL: by the landmarks on them, the others by
     * descending length. NULL is right where loops differ in length or have landmarks.
     */
    const uint32_t *loops;
    /** Number of loops. 0 with NULL. */
    size_t n_loops;
    /**
     * Threads; 0 for one per core. The result does not depend on it. 1 suits hosts that run several calls at
     * once.
     */
    size_t threads;
    /**
     * n_points x 2 faces, of the source and of the target, with points that correspond as landmarks do. They
     * suit marks from pictures, which lie between vertices.
     */
    const uint32_t *point_faces;
    /**
     * n_points x 2 x 3 barycentric coordinates in these faces, not negative, each three with the sum 1. (1,
     * 0, 0) is the first corner.
     */
    const double *point_weights;
    /** Number of pairs of points. 0 if there are none. */
    size_t n_points;
    /**
     * Pairs of curves that correspond by shares of their lengths, of each pair first the vertices on the
     * source, then those on the target: each joined to the next by an edge, closed if the last is the first.
     * They suit creases and outlines that have to be met along their whole length.
     */
    const uint32_t *curves;
    /** n_curves x 2 numbers of vertices, on the source and on the target. Both at least 2. */
    const uint32_t *curve_sizes;
    /** Number of pairs of curves. 0 if there are none. */
    size_t n_curves;
    /**
     * n_soft x 2 vertices inside the source and the target: landmarks that need not be met. They suit marks
     * that are uncertain.
     */
    const uint32_t *soft;
    /**
     * n_soft weights w, not negative: a landmark goes to the share w / (1 + w) of the way from its image
     * under the map without it to its partner. 1 goes half of the way, 9 nine tenths of it.
     */
    const double *soft_weights;
    /** Number of these landmarks. 0 if there are none. */
    size_t n_soft;
    /**
     * The correspondence of boundaries: RICCI_MATCH_SLIDES, RICCI_MATCH_ARC_LENGTH. Sliding has the least
     * distortion; shares of length suit boundaries that are cut alike.
     */
    uint32_t boundary;
    /**
     * The shape of boundary loops: RICCI_MATCH_GEODESICS, RICCI_MATCH_CIRCLES. Geodesics are the safe choice;
     * circles suit holes that are round.
     */
    uint32_t loop_shape;
    /**
     * Pairs of closed edge paths that name the homotopy class of a map of surfaces with handles, which brings
     * each to its partner; of each pair first the edges on the source, then those on the target: 1-based,
     * negative against the edge's direction, as ricci_homotopy_loops has them. They generate the fundamental
     * groups of both surfaces, on each of which all start at one vertex, but on tori. NULL: a class of low
     * energy is searched. NULL suits surfaces in similar poses.
     */
    const int32_t *basis;
    /**
     * n_basis x 2 numbers of edges, on the source and on the target. Short loops do as well as long ones of
     * the same class.
     */
    const uint32_t *basis_sizes;
    /** Number of pairs of loops. 2 g pairs for a closed surface; 0 with NULL. */
    size_t n_basis;
} ricci_match_options;

/** Figures of a matching. */
typedef struct ricci_matching_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Vertices of the source. */
    size_t n_source_vertices;
    /** Vertices of the target. */
    size_t n_target_vertices;
    /**
     * Faces that fold in the domain: 0, which makes the map a homeomorphism. Where faces fold there is no
     * matching but RICCI_MATCHING.
     */
    size_t n_flipped;
    /** Isotopy classes of maps whose energies were compared. */
    size_t n_markings;
    /** Largest distance of a vertex from the other surface's domain, as a share of the nearest triangle. */
    double outside;
    /** Energy of the source in the domain of the target; 0 where spheres are turned. */
    double energy;
    /** Energy of the target in its own domain. */
    double target_energy;
    /** Largest distance of a vertex from the mean of its neighbours, over their mean distance. */
    double residual;
    /**
     * This figure and those below are measured in space, and 0 where a surface has no positions.
     * Quasi-conformal dilatation from face to image: the mean by area, and the largest.
     */
    double qc_mean;
    /** The largest. */
    double qc_max;
    /** Area of a face's image over its own, both as shares of the totals: the smallest. */
    double area_ratio_min;
    /** The mean over the faces. */
    double area_ratio_mean;
    /** The largest. */
    double area_ratio_max;
    /** Mean by area of |ln ratio|. */
    double area_log;
    /**
     * Distance between a vertex and its image, over the diagonal of the target's bounding box: the mean by
     * area.
     */
    double distance_mean;
    /** The largest. */
    double distance_max;
    /** The largest distance of a landmark's image from its partner, over that diagonal. */
    double landmark_error;
    /**
     * Distance of a vertex from its image under the map and then the inverse map, over the diagonal of the
     * source's bounding box: the mean.
     */
    double cycle_mean;
    /** The largest. */
    double cycle_max;
    /**
     * Pairs of points that correspond: those of the options, then one for every vertex of the curves on the
     * source that is no landmark.
     */
    size_t n_points;
    /** Landmarks that need not be met. */
    size_t n_soft;
    /** Largest distance of such a point's image from its partner, over the diagonal of the target. */
    double point_error;
    /** Boundary loops that are circles of the domain. */
    size_t n_circles;
    /** Largest distance of a vertex of such a loop from its circle, as a share of the radius. */
    double roundness;
} ricci_matching_summary;

/**
 * The map from one surface to another one of the same topology, landmarks to landmarks: a harmonic map into
 * the target's metric of constant curvature, which folds no face.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no such vertex), RICCI_MATCHING (surfaces of
 * different topology, landmarks in conflict, loops that name no class, no map found), RICCI_LAYOUT,
 *         RICCI_TRIANGLE_INEQUALITY, RICCI_FACTORISATION, RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param source    the surface whose vertices are mapped.
 * @param target    the surface that they are mapped to.
 * @param options   landmarks and loops, or NULL.
 * @param control   progress and cancellation, or NULL.
 * @param matching  out: the map; free it with ricci_matching_free.
 */
RICCI_API ricci_status ricci_match(const ricci_mesh *source, const ricci_mesh *target,
                                   const ricci_match_options *options, const ricci_control *control,
                                   ricci_matching **matching);

/**
 * The same map, with landmarks that are found by the shapes of the surfaces where they make it better:
 * extremities and eigenfunctions of the Laplacian propose maps, of which the one that keeps distances best is
 * refined. Landmarks, points, soft landmarks and curves of the options are not looked at.
 * ricci_matching_found and ricci_matching_landmarks tell what was found.
 *
 * @return as ricci_match; RICCI_ARGUMENT for a surface without positions too.
 *
 * @param source    the surface whose vertices are mapped.
 * @param target    the surface that they are mapped to.
 * @param options   loops, boundary and threads, or NULL.
 * @param control   progress and cancellation, or NULL.
 * @param matching  out: the map; free it with ricci_matching_free.
 */
RICCI_API ricci_status ricci_match_by_shape(const ricci_mesh *source, const ricci_mesh *target,
                                            const ricci_match_options *options, const ricci_control *control,
                                            ricci_matching **matching);

/** Lists of landmarks of a matching. */
enum {
    /** Those that the map meets: given ones, or those that were found where they make the map better. */
    RICCI_LANDMARKS_USED = 0,
    /** Those that were found by the best candidate that keeps the sides of the surface. */
    RICCI_LANDMARKS_KEPT = 1,
    /**
     * Those that were found by the best candidate that turns the surface over: landmarks of a map from the
     * mirror image of the source, which has the same vertices.
     */
    RICCI_LANDMARKS_MIRRORED = 2
};

/**
 * What ricci_match_by_shape found. A surface with a plane of symmetry has two maps that fit equally well, one
 * of which turns it over: both are told.
 */
typedef struct ricci_found_landmarks {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Number of pairs of RICCI_LANDMARKS_USED. */
    size_t n_used;
    /** Number of pairs of RICCI_LANDMARKS_KEPT. */
    size_t n_kept;
    /** Number of pairs of RICCI_LANDMARKS_MIRRORED. */
    size_t n_mirrored;
    /** Number of candidates that begin with pairs of extremities. They come first, that of least cost before
     * others. */
    size_t n_paired;
    /** Number of candidates that begin with signs of the first eigenfunctions. */
    size_t n_signed;
    /** The number, from 0, of the candidate that keeps the sides; it has a meaning if has_kept is 1. */
    size_t candidate;
    /** The number of the candidate that turns the surface over; it has a meaning if has_mirrored is 1. */
    size_t mirrored_candidate;
    /**
     * Mean difference of distances under the map of the first, and mean distance of the target's points from
     * images, on surfaces of area 1: 0.03 to 0.04 for animals in other poses. It has a meaning if has_kept is
     * 1.
     */
    double misfit;
    /** The same of the candidate that turns the surface over. */
    double mirrored_misfit;
    /** 1 if a candidate keeps the sides of the surface. */
    uint32_t has_kept;
    /** 1 if a candidate turns the surface over. */
    uint32_t has_mirrored;
    /** 1 if one surface is like a mirror image of the other: maps that turn it over fit clearly better. */
    uint32_t mirror;
    /** Always 0. */
    uint32_t reserved;
} ricci_found_landmarks;

/**
 * What was found of landmarks. A map of ricci_match, or from an archive, was not searched for: all is 0 but
 * n_used.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no such size).
 *
 * @param matching  the matching.
 * @param found     out: the figures.
 * @param size      sizeof *found.
 */
RICCI_API ricci_status ricci_matching_found(const ricci_matching *matching, ricci_found_landmarks *found,
                                            size_t size);

/**
 * Pairs of vertices that correspond. An archive keeps none.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such kind).
 *
 * @param matching  the matching.
 * @param kind      RICCI_LANDMARKS_...
 * @param pairs     out: n x 2 vertices, of the source and of the target.
 * @param capacity  entries of `pairs`.
 */
RICCI_API ricci_status ricci_matching_landmarks(const ricci_matching *matching, uint32_t kind,
                                                uint32_t *pairs, size_t capacity);

/** What a map is good for. */
enum {
    /**
     * Values can be carried along it point by point: area_log_mean is at most 0.5, qc_mean 1.5, cycle_mean
     * 0.005, and agreement at least 0.8.
     */
    RICCI_VERDICT_GOOD = 0,
    /** Values can be carried along it where they vary slowly. */
    RICCI_VERDICT_ROUGH = 1,
    /**
     * Landmarks are needed: area_log_mean is above 2, qc_mean above 6, cycle_mean above 0.1, or agreement
     * below 0.4 on surfaces without handles.
     */
    RICCI_VERDICT_UNLIKELY = 2
};

/** How much a map distorts, and whether it brings alike points to each other. */
typedef struct ricci_matching_judgement {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Mean by area of |ln| of a face's share of the image's area over its share of its own surface. */
    double area_log_mean;
    /** That which is exceeded on 1 % of the area. */
    double area_log_99;
    /** Mean by area of the quasi-conformal dilatation of the faces. */
    double qc_mean;
    /** That which is exceeded on 1 % of the area. */
    double qc_99;
    /**
     * Mean distance of a vertex from where the map and its inverse bring it, over the diagonal of the
     * source's bounding box.
     */
    double cycle_mean;
    /**
     * Agreement of the mean distance from the surface at corresponding points: 1 where it is equal, 0 where
     * the map does no better than chance.
     */
    double agreement;
    /** RICCI_VERDICT_*. */
    uint32_t verdict;
    /** Always 0. */
    uint32_t reserved;
} ricci_matching_judgement;

/**
 * The judgement of a map, in space.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (a surface without positions; no such size),
 * RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param matching   the matching.
 * @param control    progress and cancellation, or NULL.
 * @param judgement  out: the judgement.
 * @param size       sizeof *judgement.
 */
RICCI_API ricci_status ricci_matching_judge(const ricci_matching *matching, const ricci_control *control,
                                            ricci_matching_judgement *judgement, size_t size);

/**
 * Release a matching.
 *
 * @param matching  the matching, or NULL.
 */
RICCI_API_VOID void ricci_matching_free(ricci_matching *matching);

/**
 * Figures of a matching.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (no such size).
 *
 * @param matching  the matching.
 * @param summary   out: the figures.
 * @param size      sizeof *summary.
 */
RICCI_API ricci_status ricci_matching_summarise(const ricci_matching *matching,
                                                ricci_matching_summary *summary, size_t size);

/**
 * The faces that the vertices go to.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such direction).
 *
 * @param matching   the matching.
 * @param direction  RICCI_MATCH_...
 * @param faces      out: a face of the other surface for every vertex.
 * @param capacity   entries of `faces`.
 */
RICCI_API ricci_status ricci_matching_faces(const ricci_matching *matching, uint32_t direction,
                                            uint32_t *faces, size_t capacity);

/**
 * The barycentric coordinates of the vertices' images in their faces.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (no such direction).
 *
 * @param matching   the matching.
 * @param direction  RICCI_MATCH_...
 * @param weights    out: n x 3, not negative, with the sum 1.
 * @param capacity   entries of `weights`.
 */
RICCI_API ricci_status ricci_matching_weights(const ricci_matching *matching, uint32_t direction,
                                              double *weights, size_t capacity);

/**
 * Values at the vertices of the surface that a map leads to, brought to those of the surface it comes from.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_WRONG_SIZE, RICCI_ARGUMENT (no such
 *         direction).
 *
 * @param matching   the matching.
 * @param direction  RICCI_MATCH_...
 * @param values     the same number of values for every vertex.
 * @param n_values   entries of `values`.
 * @param carried    out: as many values for every vertex of the surface that the map comes from.
 * @param capacity   entries of `carried`.
 */
RICCI_API ricci_status ricci_matching_carry(const ricci_matching *matching, uint32_t direction,
                                            const double *values, size_t n_values, double *carried,
                                            size_t capacity);

/**
 * The images of points that correspond, and their given partners, both on the target.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param matching          the matching.
 * @param faces             out: n_points x 2 faces, of the image and of the partner.
 * @param faces_capacity    entries of `faces`.
 * @param weights           out: n_points x 2 x 3 barycentric coordinates in these faces.
 * @param weights_capacity  entries of `weights`.
 */
RICCI_API ricci_status ricci_matching_points(const ricci_matching *matching, uint32_t *faces,
                                             size_t faces_capacity, double *weights, size_t weights_capacity);

/**
 * The distances of the images of landmarks that need not be met from their partners.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param matching  the matching.
 * @param left      out: n_soft lengths on the target.
 * @param capacity  entries of `left`.
 */
RICCI_API ricci_status ricci_matching_soft_left(const ricci_matching *matching, double *left,
                                                size_t capacity);

/** Of the map of a matching: faces and edges of the source. */
#define RICCI_ON_SOURCE RICCI_ON_INPUT
/** Of the map of a matching: faces and edges of the target. */
#define RICCI_ON_TARGET RICCI_ON_METRIC

/**
 * The common subdivision of the two surfaces, in the domain where they were matched.
 *
 * In the functions of the map `on` is RICCI_ON_SOURCE or RICCI_ON_TARGET. Its vertices
 * are those of the source, with their numbers, then the crossings, then the target's others, each with the
 * place that ricci_map_barycentric tells. ricci_map_mesh has them on the source.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_MATCHING (triangles so thin that the order of their lines
 * cannot be decided), RICCI_TOO_LARGE, RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param matching  the matching.
 * @param control   progress and cancellation, or NULL.
 * @param map       out: the map, to be released by ricci_map_free.
 */
RICCI_API ricci_status ricci_matching_map(const ricci_matching *matching, const ricci_control *control,
                                          ricci_map **map);

#ifdef __cplusplus
}
#endif

#endif
