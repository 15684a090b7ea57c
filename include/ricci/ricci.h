/* ricci: discrete surface Ricci flow. Flatten a triangle mesh with a prescribed curvature.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * A job, from arrays to texture coordinates on the caller's own corners; every call returns a ricci_status:
 *
 *     ricci_mesh_from_arrays(positions, 0, n_vertices, faces, n_faces, &mesh);
 *     ricci_metric_new(mesh, RICCI_SCHEME_YAMABE, RICCI_SPACE_E2, &metric);
 *     ricci_init(&target, sizeof target);
 *     target.kind = RICCI_TARGET_AUTO, target.n = 8;             // eight cones, placed by the library
 *     ricci_flow(metric, &target, NULL, NULL, &flat);            // NULL: default options, no progress
 *     ricci_report_summarise(flat, &report, sizeof report);      // converged? how far?
 *     ricci_layout_new(flat, NULL, NULL, &layout);
 *     ricci_layout_uv(layout, RICCI_ON_INPUT, uv, 6 * n_faces);  // u, v of each corner of each face
 *     ricci_metric_values(flat, RICCI_METRIC_FACTOR, factor, n_vertices);
 *
 * and the handles are freed: ricci_layout_free, ricci_metric_free (twice), ricci_mesh_free, in any order.
 *
 * Beside this header, by theme: repair.h (triangle lists with defects), labels.h (names of faces in files),
 * refine.h (smaller triangles, metrics without small angles), shapes.h (sample surfaces), charts.h (layouts
 * on the faces of the mesh, and in charts), homotopy.h (fundamental groups), uniformize.h (canonical shapes),
 * deck.h (deck groups, covers), circles.h (circle domains), seamless.h (seamless metrics), quads.h (quad
 * meshes, and layouts of four-sided patches), flatten.h (flat maps of least stretch, cortices), freesurfer.h
 * (its data), gifti.h (files of GIFTI with notes), harmonic.h (harmonic maps and 1-forms), match.h (maps
 * between surfaces), structure.h (geometric structures), spline.h, surface_spline.h and bicubic.h (splines,
 * splines over whole surfaces, and patches for CAD), quad_spline.h (splines over four-sided patches, for CAD
 * and for analysis). For C++ ricci.hpp has the classes of all themes, and openmesh.hpp, cgal.hpp and
 * eigen.hpp are adapters.
 *
 * Conventions
 *   - Every fallible call returns a ricci_status. ricci_last_error() has this thread's message,
 *     ricci_last_failure the element and the amount as numbers. Outputs are written only on success. A NULL
 *     that a call does not allow is RICCI_NULL_POINTER.
 *   - Handles are opaque: a handle that a call returns is released by the _free of its type; _free(NULL)
 *     does nothing. A `const T *` may be used by several threads at once, a `T *` is exclusive to one. A
 *     handle keeps alive the objects that it was made from, so handles may be freed in any order.
 *   - Indices are 0-based uint32_t; faces are m x 3, positions n x 3, plane points n x 2, row by row. Faces
 *     of int32_t may be cast: a negative index is refused by face and corner. Counts are numbers of rows.
 *   - An output array is given with its capacity, in entries: too small is RICCI_BUFFER_TOO_SMALL. NULL
 *     with capacity 0 asks for the number of entries: it is `needed` of ricci_last_failure, or comes in a
 *     last size_t * where there is one.
 *   - Vertices keep their numbers through flows with edge flips and their layouts; new ones come behind.
 *     Edges and faces are those of the triangulation that `on` names: RICCI_ON_INPUT the caller's mesh,
 *     RICCI_ON_METRIC the metric's triangulation, RICCI_ON_REFINEMENT the common subdivision of both.
 *   - An edge path is an int32_t array of 1-based edge numbers, negative against the edge.
 *   - Structs begin with their size. ricci_init zeroes one and writes its size; zero is the default of
 *     every field. Summaries are given with sizeof, and their `size` says how many bytes were filled.
 *   - Angles are radians; a curvature is the angle defect of a vertex: 2 pi minus its angles inside, pi
 *     minus them on the boundary.
 *   - Paths and texts are UTF-8, NUL-terminated.
 *   - No call unwinds into C: an internal error is RICCI_PANIC. Handles that the call only read stay valid;
 *     a ricci_solver that it was changing answers RICCI_POISONED from then on, and can only be freed.
 *   - A call reserves memory before the work, as much as the work is known to take. If the system refuses
 *     it, the call returns RICCI_NO_MEMORY and handles are unchanged. The reserve is released when the
 *     system refuses memory later. Three cases cannot be caught and end the program (abort, with a line on
 *     stderr): work that takes more than the reserve while the system has no memory, as with more threads
 *     than cores; the 48 bytes of a thread's handle; a stack that cannot grow.
 *   - Calls compute in the default floating-point environment and restore that of the caller: the host's
 *     floating-point traps, rounding mode and flush-to-zero neither disturb a call nor change its result.
 *   - Results are identical bit for bit for any number of threads. Threads are the call's own and have
 *     ended when it returns (a ricci_solver keeps its threads until it is freed). Where memory does not
 *     suffice for as many as are asked for, there are fewer. Nothing is printed.
 *   - A build can leave parts out (RICCI_FEATURES of CMake); their functions stay. Without `gltf`, `gifti`,
 *     `gzip` or `step` such files are RICCI_UNKNOWN_FORMAT, as is a texture for .glb. Without `splines` all
 *     of spline.h, surface_spline.h and bicubic.h, without `quads` all of seamless.h and quads.h, without
 *     `gifti` all of gifti.h answers RICCI_LEFT_OUT.
 *   - Platforms: 64-bit Linux (tested on x86-64, glibc); written for macOS and Windows, not tested there.
 *
 * Sources, by the keys of docs/bibliography.md: the unified Ricci flow [ZGZLYG14], its convergence with flips
 * [BPS15; GLSW18].
 */

#ifndef RICCI_H
#define RICCI_H

#include <stddef.h>
#include <stdint.h>

/* Visibility, and a warning where an answer is not looked at. */
#if defined(_WIN32) && !defined(RICCI_STATIC)
#define RICCI_API_VOID __declspec(dllimport)
#elif defined(__GNUC__)
#define RICCI_API_VOID __attribute__((visibility("default")))
#else
#define RICCI_API_VOID
#endif
#if defined(__GNUC__)
#define RICCI_API RICCI_API_VOID __attribute__((warn_unused_result))
#elif defined(__cplusplus) && __cplusplus >= 201703L
#define RICCI_API [[nodiscard]] RICCI_API_VOID
#else
#define RICCI_API RICCI_API_VOID
#endif

/*
 * Functions with this mark may change, or go, in a version that keeps all others. With
 * RICCI_WARN_EXPERIMENTAL defined before the headers a compiler warns where they are used.
 */
#if defined(RICCI_WARN_EXPERIMENTAL) && defined(__GNUC__)
#define RICCI_EXPERIMENTAL __attribute__((deprecated("experimental: a later version may change it")))
#else
#define RICCI_EXPERIMENTAL
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------------------------------------------------
 * Versions and failures
 */

/**
 * Version of this header. Until 1.0 a new minor version is incompatible: the shared library is
 * libricci.so.0.MINOR.
 */
#define RICCI_VERSION_MAJOR 0
#define RICCI_VERSION_MINOR 1
#define RICCI_VERSION_PATCH 0
/** The same as one number: 1000000 major + 1000 minor + patch. */
#define RICCI_VERSION (1000000 * RICCI_VERSION_MAJOR + 1000 * RICCI_VERSION_MINOR + RICCI_VERSION_PATCH)

/**
 * The status that a call returns. 1-9 are errors of the call, 10-99 of the C face, 100s of files, 200s of
 * meshes, 300s of metrics, 400s of targets, 500s of solvers, 600s of layouts and matchings, 700s of splines.
 * A number is never given out again.
 */
typedef uint32_t ricci_status;
enum {
    /** Done. */
    RICCI_OK = 0,
    /** An array does not have the size the call needs. */
    RICCI_WRONG_SIZE = 1,
    /** An argument or option is outside its range. */
    RICCI_ARGUMENT = 2,
    /** More elements than a 32-bit index can number. */
    RICCI_TOO_LARGE = 3,
    /** Cancelled through the ricci_control; inputs are unchanged. */
    RICCI_CANCELLED = 4,
    /** A pointer that must not be NULL is NULL. */
    RICCI_NULL_POINTER = 10,
    /** An internal error, a defect of the library; a solver that the call was changing is poisoned. */
    RICCI_PANIC = 11,
    /** An earlier call on this solver ended in RICCI_PANIC; it can only be freed. */
    RICCI_POISONED = 12,
    /** The caller's buffer is too small; `needed` of ricci_last_failure says how many entries there are. */
    RICCI_BUFFER_TOO_SMALL = 13,
    /** A struct has a size, or a field, that this version of the library does not know. */
    RICCI_STRUCT_SIZE = 14,
    /** There is not enough memory; handles are unchanged. */
    RICCI_NO_MEMORY = 15,
    /** The function belongs to a part that was left out when the library was built. */
    RICCI_LEFT_OUT = 16,
    /**
     * A file could not be read or written; amount: the number of the system's error (errno), 0 if it has
     * none.
     */
    RICCI_IO = 100,
    /** A file's content is not what its format says. */
    RICCI_PARSE = 101,
    /** No reader or writer for this file name. */
    RICCI_UNKNOWN_FORMAT = 102,
    /**
     * The faces do not form a connected oriented surface; ricci_soup_defect of ricci/repair.h lists every
     * defect.
     */
    RICCI_DEFECTS = 200,
    /** The gluing of an intrinsic surface is inconsistent. */
    RICCI_GLUING = 201,
    /** A rule of the connectivity does not hold. */
    RICCI_CONNECTIVITY = 202,
    /** An edge length is not finite and positive; amount: the length. */
    RICCI_EDGE_LENGTH = 300,
    /**
     * Edge lengths break the triangle inequality; amount: by how much the longest side exceeds the other
     * two, relative to it.
     */
    RICCI_TRIANGLE_INEQUALITY = 301,
    /** The scheme cannot represent the metric on an edge; amount: the weight eta. */
    RICCI_EDGE_WEIGHT = 302,
    /** A conformal variable is outside the metric's domain; amount: the variable. */
    RICCI_DOMAIN = 303,
    /** A target curvature is too large at a vertex; amount: by how much, radians. */
    RICCI_TARGET_AT_VERTEX = 400,
    /** The target curvatures do not add up to what Gauss-Bonnet asks for; amount: by how much, radians. */
    RICCI_TARGET_TOTAL = 401,
    /** This kind of target does not exist for this surface and space. */
    RICCI_TARGET_KIND = 402,
    /** A target curvature is too small at a vertex; amount: by how much, radians. */
    RICCI_TARGET_BELOW = 403,
    /** A linear system could not be factorised. */
    RICCI_FACTORISATION = 500,
    /** The metric has no layout in this space. */
    RICCI_LAYOUT = 600,
    /** There is no map of the kind that was asked for between two surfaces. */
    RICCI_MATCHING = 650,
    /** A spline, or an argument that one is made from, is not what it must be. */
    RICCI_SPLINE = 700
};

/** The kind of element that the index of a ricci_failure counts. */
enum {
    /** Nothing. */
    RICCI_ELEMENT_NONE = 0,
    /** Vertices. */
    RICCI_ELEMENT_VERTEX = 1,
    /** Edges, 0-based. */
    RICCI_ELEMENT_EDGE = 2,
    /** Faces. */
    RICCI_ELEMENT_FACE = 3,
    /** Entries, or rows, of an array of the caller's, or of a list of the library's. */
    RICCI_ELEMENT_ENTRY = 4,
    /** Lines of a file, from 1. */
    RICCI_ELEMENT_LINE = 5,
    /** Bytes of a file. */
    RICCI_ELEMENT_BYTE = 6
};

/** The last failed call of a thread, as numbers. */
typedef struct ricci_failure {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** The status that it returned. */
    ricci_status status;
    /** A RICCI_ELEMENT_*: the kind of element that `index` counts. */
    uint32_t element;
    /** The element concerned, 0-based (lines from 1); -1 where the failure has no number of one. */
    int64_t index;
    /** By how much, as the status says; 0 where it says nothing. */
    double amount;
    /** Entries that a buffer or an array needs; 0 if the call did not fail for a size. */
    size_t needed;
} ricci_failure;

/**
 * Version of the library that is running, "major.minor.patch".
 *
 * Never fails; the text lives as long as the program.
 * @return a NUL-terminated string; not to be freed.
 */
RICCI_API const char *ricci_version(void);

/**
 * The same as a number, to be compared with RICCI_VERSION.
 *
 * Never fails.
 * @return 1000000 major + 1000 minor + patch.
 */
RICCI_API uint32_t ricci_version_number(void);

/**
 * One sentence on a status, in English; the text lives as long as the program.
 *
 * Never fails: a number that is no status gives "unknown status".
 * @return a NUL-terminated UTF-8 string; not to be freed.
 *
 * @param status  the status that a call returned.
 */
RICCI_API const char *ricci_status_text(ricci_status status);

/**
 * The message of the last call of this thread that failed: which element, by how much, what to do.
 *
 * The address is the same for the whole life of the thread, so that it may be used in one expression with the
 * call, in either order of evaluation; the next failure of this thread writes over the text. Empty if no call
 * has failed. At most 1023 bytes.
 * @return a NUL-terminated UTF-8 string; not to be freed.
 */
RICCI_API const char *ricci_last_error(void);

/**
 * The last call of this thread that failed, as numbers. Successful calls leave it alone.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param failure  out: the numbers.
 * @param size     sizeof *failure.
 */
RICCI_API ricci_status ricci_last_failure(ricci_failure *failure, size_t size);

/**
 * Zero a struct of the caller's and write its size into its first member: the start of all options and
 * specs.
 *
 * The size stays the caller's. A library that is older refuses a later field with RICCI_STRUCT_SIZE unless
 * it is zero.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param options  out: the struct, one that begins with `size_t size`.
 * @param size     sizeof *options.
 */
RICCI_API ricci_status ricci_init(void *options, size_t size);

/** How much is logged. */
enum {
    /** Nothing. */
    RICCI_LOG_OFF = 0,
    /** Internal errors. */
    RICCI_LOG_ERROR = 1,
    /** Calls that fail, with their message. */
    RICCI_LOG_WARN = 2,
    /** Results: how each flow ended. */
    RICCI_LOG_INFO = 3,
    /** Single steps of a call. */
    RICCI_LOG_DEBUG = 4,
    /** Everything. */
    RICCI_LOG_TRACE = 5
};

/**
 * Receives one message, of a level RICCI_LOG_*. May be called from any thread, by several at once; it must
 * not call into the library. `message` is NUL-terminated UTF-8 and valid during the call only.
 */
typedef void (*ricci_log_callback)(uint32_t level, const char *message, void *user_data);

/**
 * Send the library's log messages to a callback, for the whole process: the only global state there is.
 *
 * Nothing is logged before the first call, and nothing is ever printed. When the call returns, the callback
 * that was set before is no longer running and will not be called again.
 * @return RICCI_OK, RICCI_ARGUMENT (unknown level).
 *
 * @param callback   the function, or NULL to stop logging.
 * @param user_data  handed to the callback as it is; may be NULL.
 * @param level      RICCI_LOG_*: the most detailed level that is sent.
 */
RICCI_API ricci_status ricci_log_set(ricci_log_callback callback, void *user_data, uint32_t level);

/* ---------------------------------------------------------------------------------------------------------
 * Progress and cancelling
 */

/**
 * Progress of a long call and the means to cancel it. Every function on it may be called from any thread at
 * any time between ricci_control_new and ricci_control_free.
 */
typedef struct ricci_control ricci_control;

/** The stage that a long call is in. */
enum {
    /** Nothing has started. */
    RICCI_STAGE_IDLE = 0,
    /** Reading a file. */
    RICCI_STAGE_READ = 1,
    /** Building connectivity. */
    RICCI_STAGE_BUILD = 2,
    /** Solving for the metric. */
    RICCI_STAGE_FLOW = 3,
    /** Laying the metric out. */
    RICCI_STAGE_LAYOUT = 4,
    /** Writing a file. */
    RICCI_STAGE_WRITE = 5
};

/**
 * A fresh control: no progress, not cancelled. One may serve several calls, one after the other.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER.
 *
 * @param control  out: the new handle, to be released by ricci_control_free.
 */
RICCI_API ricci_status ricci_control_new(ricci_control **control);

/**
 * Release a control. A call that is still running with it keeps what it needs.
 *
 * @param control  the handle, or NULL.
 */
RICCI_API_VOID void ricci_control_free(ricci_control *control);

/**
 * Ask the running call, and every later one with this control, to stop; it cannot be taken back.
 *
 * The call returns RICCI_CANCELLED at its next check, its inputs unchanged and no output written; a
 * factorisation under way finishes first.
 * @return RICCI_OK, RICCI_NULL_POINTER.
 *
 * @param control  the handle the call was given.
 */
RICCI_API ricci_status ricci_control_cancel(const ricci_control *control);

/**
 * The number of threads of the calls that have no option for it: ricci_spline_closest and
 * ricci_spline_tessellate. Results do not depend on it.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER.
 *
 * @param control  the handle that calls are given.
 * @param threads  0 for one per core, the default; at most 256 are used.
 */
RICCI_API ricci_status ricci_control_set_threads(const ricci_control *control, size_t threads);

/**
 * This thread's calls that are given no control use this one from now on, also those that have no argument
 * for it: reading, building, repairing and writing. Between the parts of such a call the control is looked
 * at.
 *
 * @return RICCI_OK.
 *
 * @param control  the handle, which may be released before the calls end; NULL: none, as at the beginning.
 */
RICCI_API ricci_status ricci_control_use(const ricci_control *control);

/**
 * The part of the whole progress that the next calls with this control fill, for a host that shows several
 * calls in one bar. Without it every call runs from 0 to 1.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (not 0 <= from <= to <= 1).
 *
 * @param control  the handle that calls are given.
 * @param from     the fraction at which the next call begins; progress never goes back, unless the part is
 * all, 0 to 1, with which each call begins at 0 again.
 * @param to       the fraction at which it ends.
 */
RICCI_API ricci_status ricci_control_part(const ricci_control *control, double from, double to);

/**
 * The stage that the call is in, and the fraction of the whole call that is done.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER.
 *
 * @param control       the handle the call was given.
 * @param stage         out: RICCI_STAGE_*, the current stage.
 * @param fraction      out: the fraction of the call that is done, in [0, 1]: 0 at its beginning, never less
 * than before, 1 once it has succeeded.
 * @param since_cancel  out: seconds since the first ricci_control_cancel, -1 if there was none; NULL if not
 *                      wanted. Asked right after a call has returned RICCI_CANCELLED it is the latency.
 */
RICCI_API ricci_status ricci_control_progress(const ricci_control *control, uint32_t *stage, double *fraction,
                                              double *since_cancel);

/* ---------------------------------------------------------------------------------------------------------
 * Meshes
 */

/** A connected oriented triangulated surface with the lengths of its edges. It never changes. */
typedef struct ricci_mesh ricci_mesh;

/** Geometries: of input lengths, and those in which metrics live. lambda is the curvature. */
enum {
    /** The Euclidean plane, lambda = 0. */
    RICCI_SPACE_E2 = 0,
    /** The hyperbolic plane, lambda = -1. */
    RICCI_SPACE_H2 = 1,
    /** The unit sphere, lambda = 1. */
    RICCI_SPACE_S2 = 2
};

/** Numbers of a mesh, or of the triangle lists of ricci/repair.h. */
enum {
    /** n_vertices x 3. */
    RICCI_POSITIONS = 0,
    /** n_edges; of meshes only. */
    RICCI_LENGTHS = 1,
    /** n_vertices x 3, of any length. */
    RICCI_NORMALS = 2,
    /** n_vertices x 4: red, green, blue, opacity, from 0 to 1. */
    RICCI_COLORS = 3,
    /** Texture coordinates, n_faces x 3 x 2: u, v of every corner, v upwards. */
    RICCI_UV = 4,
    /** n_faces x 3 x 3, of any length: of surfaces whose vertices have several normals, as at hard edges. */
    RICCI_CORNER_NORMALS = 5
};

/** Counts of a mesh. */
typedef struct ricci_mesh_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** V. */
    size_t n_vertices;
    /** E. */
    size_t n_edges;
    /** F. */
    size_t n_faces;
    /** Number of boundary loops; 0 for a closed surface. */
    size_t n_boundary_loops;
    /** Number of vertices on the boundary. */
    size_t n_boundary_vertices;
    /** V - E + F. */
    int64_t euler;
    /** (2 - euler - boundary loops) / 2. */
    size_t genus;
    /** 1 if its vertices have positions in space, 0 for an intrinsic surface. */
    uint32_t has_positions;
    /** RICCI_SPACE_*: the geometry in which its lengths are meant. */
    uint32_t geometry;
    /** Number of normals of vertices: V, or 0 if the mesh was not read from a file that has them. */
    size_t n_normals;
    /** Number of colours: V, or 0. */
    size_t n_colors;
    /** Number of faces with texture coordinates: F, or 0. */
    size_t n_uv;
    /** Number of faces with normals at their corners, instead of those of the vertices: F, or 0. */
    size_t n_corner_normals;
} ricci_mesh_summary;

/** Triangles glued along numbered edges, with a length for every edge. Zeroed by ricci_init. */
typedef struct ricci_gluing {
    /** sizeof(ricci_gluing). */
    size_t size;
    /** Number of vertices. */
    size_t n_vertices;
    /** n_faces x 3 vertex indices (a, b, c). */
    const uint32_t *faces;
    /**
     * n_faces x 3 edge numbers (bc, ca, ab): 1-based, negative where the face runs against the edge's
     * direction; each edge once with either sign, or once only (boundary).
     */
    const int32_t *face_edges;
    /** Number of triangles, at least 1. */
    size_t n_faces;
    /** n_edges lengths, finite and positive; entry e - 1 is that of edge number e. */
    const double *lengths;
    /** Number of edges. */
    size_t n_edges;
    /** RICCI_SPACE_*: the geometry in which the lengths are meant. */
    uint32_t geometry;
    /** 0. */
    uint32_t reserved;
} ricci_gluing;

/**
 * Attributes that are written beside positions and faces; NULL where there are none. Zeroed by ricci_init.
 */
typedef struct ricci_attributes {
    /** sizeof(ricci_attributes). */
    size_t size;
    /** As RICCI_NORMALS. */
    const double *normals;
    /** As RICCI_COLORS. */
    const double *colors;
    /** As RICCI_UV. */
    const double *uv;
    /** As RICCI_CORNER_NORMALS, in place of the normals of the vertices. */
    const double *corner_normals;
    /** A texture for `uv`: the bytes of a PNG file. For .glb files. */
    const uint8_t *png;
    /** Their number. */
    size_t png_size;
    /** RICCI_WRAP_*: how the texture goes on outside the unit square. */
    uint32_t wrap;
    /** 0. */
    uint32_t reserved;
} ricci_attributes;

/** How a texture goes on outside the unit square. */
enum {
    /** Periodically. */
    RICCI_WRAP_REPEAT = 0,
    /** Periodically, every other time mirrored. */
    RICCI_WRAP_MIRROR = 1,
    /** With the colours of its border. */
    RICCI_WRAP_CLAMP = 2
};

/**
 * A mesh from positions and faces.
 *
 * Both arrays are copied; vertices, faces and corners keep their order and numbers.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (stride; a negative index), RICCI_TOO_LARGE,
 * RICCI_NO_MEMORY, RICCI_DEFECTS (ricci_soup_from_arrays and ricci_soup_defect of ricci/repair.h list
 * them).
 *
 * @param positions   n_vertices points: x, y, z as double; finite.
 * @param stride      bytes from one point to the next, at least 24; 0 means 24. Need not be a multiple of
 *                    8.
 * @param n_vertices  number of points.
 * @param faces       n_faces x 3 vertex indices, 0-based, consistently oriented.
 * @param n_faces     number of triangles, at least 1.
 * @param mesh        out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_mesh_from_arrays(const double *positions, size_t stride, size_t n_vertices,
                                              const uint32_t *faces, size_t n_faces, ricci_mesh **mesh);

/**
 * An intrinsic surface: triangles glued along numbered edges, and a length for every edge.
 *
 * Two vertices may share several edges, an edge may be a loop, a face may be glued to itself.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_WRONG_SIZE (`n_edges` is not the number of
 * edges), RICCI_GLUING, RICCI_DEFECTS, RICCI_EDGE_LENGTH, RICCI_ARGUMENT, RICCI_TOO_LARGE, RICCI_NO_MEMORY.
 *
 * @param gluing  the triangles and lengths.
 * @param mesh    out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_mesh_from_gluing(const ricci_gluing *gluing, ricci_mesh **mesh);

/**
 * The same mesh with lengths of the caller's in place of its own. Positions, if it has any, then only serve
 * to draw and write.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_WRONG_SIZE, RICCI_EDGE_LENGTH, RICCI_ARGUMENT,
 * RICCI_NO_MEMORY.
 *
 * @param mesh      the mesh.
 * @param lengths   n_edges lengths, finite and positive, in the order of ricci_mesh_edges.
 * @param n_edges   number of edges of the mesh.
 * @param geometry  RICCI_SPACE_*: the geometry in which the lengths are meant.
 * @param result    out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_mesh_with_lengths(const ricci_mesh *mesh, const double *lengths, size_t n_edges,
                                               uint32_t geometry, ricci_mesh **result);

/**
 * A mesh from a file, with the attributes that it has.
 *
 * Vertices and faces have the file's numbers; polygons are cut into triangles. Corners of an STL file in
 * exactly the same place are one vertex. Files with defects: ricci_soup_read of ricci/repair.h.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (not UTF-8), RICCI_IO, RICCI_PARSE,
 * RICCI_UNKNOWN_FORMAT, RICCI_DEFECTS.
 *
 * @param path  file name in UTF-8, ending in .obj, .off, .ply, .stl, .glb, .gltf, .gii, .vtk, .vtp, .mz3, or
 *              as FreeSurfer names surfaces (.white, .pial, .inflated, .sphere, .reg, .orig, .smoothwm,
 *              .midthickness, .asc), or in one of these and .gz.
 * @param mesh  out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_mesh_read(const char *path, ricci_mesh **mesh);

/**
 * Write a mesh in the format of the file's extension, with the attributes that the format has.
 *
 * OBJ and OFF are text with as many digits as are needed, PLY is binary, and positions read back as they are;
 * GLB has 24 bits of the distance from the centre of the mesh, and writes a vertex with several texture
 * coordinates once for each. VTK has 64 bits, MZ3 and binary surfaces of FreeSurfer 24. Attributes that the
 * format has no place for (in PLY, OFF and VTK, several normals at a vertex; in OFF and VTK, several texture
 * coordinates; in files of FreeSurfer, all) are left out, with a warning to the callback of ricci_log_set. A
 * file of that name is replaced only once the new one is complete.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_UNKNOWN_FORMAT, RICCI_STRUCT_SIZE, RICCI_ARGUMENT
 * (the mesh is intrinsic, a number is not finite, the texture is no PNG file or has no uv),
 * RICCI_TOO_LARGE, RICCI_NO_MEMORY.
 *
 * @param mesh        the mesh.
 * @param attributes  the attributes to write beside positions and faces, or NULL for those that the mesh was
 *                    read with.
 * @param path        file name in UTF-8, ending in .obj, .off, .ply, .glb, .vtk, .vtp, .mz3 or .gii, or as
 *                    FreeSurfer names surfaces; .gz behind packs it.
 */
RICCI_API ricci_status ricci_mesh_write(const ricci_mesh *mesh, const ricci_attributes *attributes,
                                        const char *path);

/**
 * Release a mesh. Metrics made from it live on.
 *
 * @param mesh  the handle, or NULL.
 */
RICCI_API_VOID void ricci_mesh_free(ricci_mesh *mesh);

/**
 * Counts, Euler characteristic, genus, boundary loops, and which attributes there are. Counted once per
 * handle.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param mesh     the mesh.
 * @param summary  out: the counts.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_mesh_summarise(const ricci_mesh *mesh, ricci_mesh_summary *summary, size_t size);

/** How well shaped triangles are. NaN where a list of triangles does not have it. */
typedef struct ricci_quality_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** Area of all faces. */
    double area;
    /** The smallest angle, radians; 0 of a face without area. */
    double min_angle;
    /** Share of the faces with an angle above 90 degrees. */
    double obtuse_fraction;
    /** Longest over shortest edge; NaN if an edge has length 0. */
    double edge_ratio;
    /** Share of the interior edges whose opposite angles add up to more than pi; NaN of what is no surface.
     */
    double non_delaunay_fraction;
} ricci_quality_summary;

/**
 * How well shaped the triangles of a mesh are, by its lengths.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_EDGE_LENGTH.
 *
 * @param mesh     the mesh.
 * @param quality  out: the figures.
 * @param size     sizeof *quality.
 */
RICCI_API ricci_status ricci_mesh_quality(const ricci_mesh *mesh, ricci_quality_summary *quality,
                                          size_t size);

/**
 * Positions, lengths, or an attribute that the mesh was read with.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT (it has none),
 * RICCI_EDGE_LENGTH (two positions coincide).
 *
 * @param mesh      the mesh.
 * @param which     RICCI_POSITIONS, RICCI_LENGTHS, RICCI_NORMALS, RICCI_COLORS, RICCI_UV or
 *                  RICCI_CORNER_NORMALS.
 * @param values    out: the numbers, in the shape that is documented at the constant.
 * @param capacity  entries of `values`.
 */
RICCI_API ricci_status ricci_mesh_values(const ricci_mesh *mesh, uint32_t which, double *values,
                                         size_t capacity);

/**
 * The vertices of every face, in corner order.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param mesh      the mesh.
 * @param faces     out: n_faces x 3 vertex indices (a, b, c).
 * @param capacity  entries of `faces`, at least 3 n_faces.
 */
RICCI_API ricci_status ricci_mesh_faces(const ricci_mesh *mesh, uint32_t *faces, size_t capacity);

/**
 * The two ends of every edge, in the edge's direction.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param mesh      the mesh.
 * @param edges     out: n_edges x 2 vertex indices.
 * @param capacity  entries of `edges`, at least 2 n_edges.
 */
RICCI_API ricci_status ricci_mesh_edges(const ricci_mesh *mesh, uint32_t *edges, size_t capacity);

/**
 * The edges opposite the corners of every face: how the triangles are glued, and the indices of a face's
 * sides in per-edge arrays.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param mesh        the mesh.
 * @param face_edges  out: n_faces x 3 edge numbers (bc, ca, ab): 1-based, negative where the face runs
 *                    against the edge's direction.
 * @param capacity    entries of `face_edges`, at least 3 n_faces.
 */
RICCI_API ricci_status ricci_mesh_face_edges(const ricci_mesh *mesh, int32_t *face_edges, size_t capacity);

/**
 * The vertices of every boundary loop, each loop with the surface on its left.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param mesh               the mesh.
 * @param vertices           out: n_boundary_vertices vertex indices, loop after loop.
 * @param vertices_capacity  entries of `vertices`.
 * @param starts             out: n_boundary_loops + 1 offsets: loop i is vertices[starts[i] .. starts[i +
 *                           1]).
 * @param starts_capacity    entries of `starts`.
 */
RICCI_API ricci_status ricci_mesh_boundary(const ricci_mesh *mesh, uint32_t *vertices,
                                           size_t vertices_capacity, size_t *starts, size_t starts_capacity);

/* ---------------------------------------------------------------------------------------------------------
 * Metrics
 *
 * A conformal class has a type epsilon per vertex and a weight eta per edge; a metric of the class has one
 * variable u per vertex. With e_i = exp(u_i) and d_i = 1 + lambda epsilon_i e_i^2,
 *
 *     N_ij = 2 eta_ij e_i e_j + epsilon_i e_i^2 + epsilon_j e_j^2
 *     l_ij^2 = N_ij (E2),   sinh^2(l_ij / 2) = N_ij / (d_i d_j) (H2),   sin^2(l_ij / 2) = N_ij / (d_i d_j)
 * (S2).
 */

/**
 * A metric of a surface in a conformal class, with the report of the flow that led to it. It never changes; a
 * flow makes a new one.
 *
 * A flow that flips edges leads to another triangulation, on which edges and faces have numbers of their
 * own (ricci_metric_mesh), and of a surface with boundary to one of its double; layouts and maps lead back.
 */
typedef struct ricci_metric ricci_metric;

/** How edge lengths depend on u. */
enum {
    /** Vertex scaling (discrete Yamabe), epsilon = 0; represents any input metric exactly. */
    RICCI_SCHEME_YAMABE = 0,
    /** Inversive distance circle packing, epsilon = 1; represents any input metric exactly. */
    RICCI_SCHEME_INVERSIVE = 1,
    /**
     * Thurston's circle packing: circles meet at angles in [0, pi/2], eta is their cosine; changes lengths
     * at the start.
     */
    RICCI_SCHEME_THURSTON = 2,
    /** Tangential (combinatorial) circle packing, eta = 1: ignores lengths but for the initial radii. */
    RICCI_SCHEME_TANGENTIAL = 3,
    /** Virtual radius circle packing, epsilon = -1: imaginary circles. */
    RICCI_SCHEME_VIRTUAL = 4
};

/** The triangulation that a question is about. */
enum {
    /** The caller's mesh, as it was given: its own vertices, edges, faces and corners, in its order. */
    RICCI_ON_INPUT = 0,
    /** The triangulation that the metric lives on (ricci_metric_mesh). */
    RICCI_ON_METRIC = 1,
    /**
     * Their common subdivision: faces that are parts of faces of both (ricci_map). If no edge was flipped,
     * all three are the same.
     */
    RICCI_ON_REFINEMENT = 2
};

/** Numbers of a metric. */
enum {
    /**
     * n_vertices: the conformal factor f against the input. Vertex scaling: the change of u, so that where
     * no edge was flipped l_ij = exp((f_i + f_j) / 2) l0_ij in E2 from E2 lengths (sinh(l/2) for l in H2,
     * sin(l/2) in S2), and areas near vertex i change by about exp(2 f_i). Circle packings: log of new
     * radius over old.
     */
    RICCI_METRIC_FACTOR = 0,
    /** n_vertices: curvatures, radians. */
    RICCI_METRIC_CURVATURE = 1,
    /** n_vertices: u. */
    RICCI_METRIC_U = 2,
    /** n_vertices: epsilon, 1 circle, 0 vertex scaling, -1 imaginary circle. */
    RICCI_METRIC_TYPE = 3,
    /** n_edges: lengths of the edges of the metric's triangulation. */
    RICCI_METRIC_LENGTH = 4,
    /** n_edges: eta of the edges of the metric's triangulation. */
    RICCI_METRIC_ETA = 5,
    /** n_mesh_vertices: u of the vertices of the metric's triangulation; mirror images differ by rounding. */
    RICCI_METRIC_MESH_U = 6
};

/** Figures of a metric. */
typedef struct ricci_metric_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** RICCI_SPACE_*: the geometry of its triangles. */
    uint32_t space;
    /** RICCI_SPACE_*: the geometry in which the input lengths were read. */
    uint32_t input_geometry;
    /** RICCI_SCHEME_*. */
    uint32_t scheme;
    /** 1 if its triangulation is one of the double of the surface: two copies glued along the boundary. */
    uint32_t doubled;
    /** V of the mesh it was made from, the entries of per-vertex arrays. */
    size_t n_vertices;
    /**
     * V of its triangulation: those of the mesh, and of a double the mirror images of interior vertices
     * behind them.
     */
    size_t n_mesh_vertices;
    /** E of its triangulation, the entries of per-edge arrays. */
    size_t n_edges;
    /** F of its triangulation. */
    size_t n_faces;
    /** Area of the surface, in units of the input length squared (E2) or of 1/|curvature|. */
    double area;
    /** |sum of curvatures + lambda area - 2 pi chi| of its triangulation: rounding only. */
    double gauss_bonnet;
    /** Number of triangles whose lengths break the triangle inequality. */
    size_t broken_triangles;
    /** Edges whose initial weight the scheme had to change (Thurston). */
    size_t clamped_edges;
    /** Largest relative change of an edge length by the change to the scheme. */
    double max_length_change;
    /** Edge flips from the mesh it was made from to its triangulation. */
    size_t n_flips;
    /** Those of them that come before the flow and change no distance on the surface. */
    size_t n_start_flips;
    /**
     * The distance of the metric that the scheme starts from, from that of the surface: largest |log| of a
     * length of the start over that of the surface; 0 with schemes that represent every metric.
     */
    double max_log_length;
    /** The mean of that over the sides of the faces. */
    double mean_log_length;
    /** Largest dilatation of the maps from the surface's triangles to those of the start. */
    double max_dilatation;
    /** Its mean, weighed with areas. Flows are conformal to the start, so refining does not lower it. */
    double mean_dilatation;
    /**
     * 1 if the start is so far (mean dilatation above 1.02, or a largest one above 2) that results belong to
     * another conformal structure than the surface's; else 0.
     */
    uint32_t far;
    /** 0. */
    uint32_t reserved;
} ricci_metric_summary;

/**
 * The initial metric of a mesh in the conformal class of its lengths.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT, RICCI_EDGE_LENGTH, RICCI_TRIANGLE_INEQUALITY,
 * RICCI_EDGE_WEIGHT, RICCI_DOMAIN.
 *
 * @param mesh    the mesh.
 * @param scheme  RICCI_SCHEME_*: how lengths depend on u.
 * @param space   RICCI_SPACE_*: the geometry in which the metric will live.
 * @param metric  out: the new handle, to be released by ricci_metric_free.
 */
RICCI_API ricci_status ricci_metric_new(const ricci_mesh *mesh, uint32_t scheme, uint32_t space,
                                        ricci_metric **metric);

/**
 * Release a metric.
 *
 * @param metric  the handle, or NULL.
 */
RICCI_API_VOID void ricci_metric_free(ricci_metric *metric);

/**
 * Kind, counts, area and Gauss-Bonnet residual of a metric. Computed once per metric.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param metric   the metric.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_metric_summarise(const ricci_metric *metric, ricci_metric_summary *summary,
                                              size_t size);

/**
 * The numbers of a metric at vertices or edges.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT.
 *
 * @param metric    the metric.
 * @param which     RICCI_METRIC_*.
 * @param values    out: the numbers, as many as documented at the constant.
 * @param capacity  entries of `values`.
 */
RICCI_API ricci_status ricci_metric_values(const ricci_metric *metric, uint32_t which, double *values,
                                           size_t capacity);

/**
 * The triangulation of a metric as an intrinsic mesh with the metric's lengths.
 *
 * It is that of the mesh that the metric was made from until a flow flips edges. Two vertices may then
 * share several edges, and an edge may be a loop. The triangulation of a double (`doubled` of the summary)
 * is closed; its first vertices are the given ones, and its edges may run from one copy of the surface to
 * the other.
 * @return RICCI_OK, RICCI_NULL_POINTER.
 *
 * @param metric  the metric.
 * @param mesh    out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_metric_mesh(const ricci_metric *metric, ricci_mesh **mesh);

/**
 * The mirror image of every vertex of the triangulation: itself, but inside a surface that was doubled.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param metric    the metric.
 * @param mirror    out: n_mesh_vertices vertex indices.
 * @param capacity  entries of `mirror`.
 */
RICCI_API ricci_status ricci_metric_mirror(const ricci_metric *metric, uint32_t *mirror, size_t capacity);

/* ---------------------------------------------------------------------------------------------------------
 * Targets and flows
 *
 * A target is admissible if every curvature is below 2 pi (pi on the boundary) and they add up to 2 pi chi
 * - lambda area: in E2 to 2 pi chi, in H2 to more, in S2 to less.
 */

/** Rules for a target. */
enum {
    /**
     * In H2 and S2: uniform. In E2: on spheres four cones of pi; on other closed surfaces uniform; on open
     * ones of genus 0 outer; on open ones with handles auto, with |chi| cones, 4 to 64.
     */
    RICCI_TARGET_DEFAULT = 0,
    /** The same curvature everywhere: 2 pi chi / V on a closed surface in E2, 0 in H2 and S2. */
    RICCI_TARGET_UNIFORM = 1,
    /** 0 inside, 2 pi chi shared over the boundary in proportion to adjacent boundary length. E2 only. */
    RICCI_TARGET_BOUNDARY = 2,
    /** All curvature, 2 pi chi, at the one vertex of `vertices`. E2 only. */
    RICCI_TARGET_SINGLE = 3,
    /** `curvatures` at the n `vertices`, 0 at every other one. */
    RICCI_TARGET_CONES = 4,
    /**
     * n cones (at most 256) placed by the library: interior vertices, and their curvatures, such that a
     * conformal map that is flat elsewhere changes areas as little as it finds. On an open surface the
     * boundary keeps its conformal factor, and has the curvature that follows. E2, from E2 lengths. Closed
     * surfaces of genus 0 need 3 cones, of genus 1 none or 2, of higher genus 1.
     */
    RICCI_TARGET_AUTO = 5,
    /** `curvatures` of all n = n_vertices vertices. */
    RICCI_TARGET_GIVEN = 6,
    /**
     * 0 inside; the outer loop keeps its lengths and is free to bend: the longest one with n = 0, with n = 1
     * that through the one vertex of `vertices`. The other loops bend so that the surface unrolls around
     * each of them to where it began, as if the holes were filled: the layout is one piece without a seam,
     * and isometric if the surface can be unrolled. Where a triangle would break, edges of the loops are
     * flipped like others, so that they bend in the layout, those of the outer loop last; ricci_metric_mesh
     * then also covers the filled holes. With pinned vertices 0 at all others. E2, open surfaces of genus 0.
     */
    RICCI_TARGET_OUTER = 7
};

/** A target by rule or by value. Zeroed by ricci_init: the default. */
typedef struct ricci_target {
    /** sizeof(ricci_target). */
    size_t size;
    /**
     * RICCI_TARGET_*. Begin with the default, or with RICCI_TARGET_AUTO and 8 cones where areas should change
     * little.
     */
    uint32_t kind;
    /** 0. */
    uint32_t reserved;
    /** Number of cones, or of vertices, as the kind says. */
    size_t n;
    /** n vertices (SINGLE, CONES, OUTER). */
    const uint32_t *vertices;
    /** n curvatures, radians (CONES, GIVEN). */
    const double *curvatures;
} ricci_target;

/** How a flow is solved. */
enum {
    /** Newton's method on the convex energy. */
    RICCI_METHOD_NEWTON = 0,
    /** The gradient flow du/dt = target - K, explicit in time, with a trace. */
    RICCI_METHOD_GRADIENT = 1
};

/** The rule for edge flips while the metric flows. */
enum {
    /**
     * As often as needed, so that every admissible target is reached: the flow starts from the intrinsic
     * Delaunay triangulation and keeps it (weighted) Delaunay; a surface with boundary flows on its double
     * as soon as an edge is to be flipped across the boundary, unless vertices are pinned. Applies to
     * Newton's method in E2 and H2 with vertex scaling, inversive distance and virtual radius; else edges
     * stay as they are.
     */
    RICCI_FLIPS_AUTO = 0,
    /** The triangulation of the metric stays as it is. */
    RICCI_FLIPS_NEVER = 1
};

/**
 * Step size of the gradient flow. The energy falls at every step, except with plain Barzilai-Borwein steps:
 * a step after which it has not fallen enough (Armijo's rule) is shortened.
 */
enum {
    /** The step that Barzilai and Borwein propose, shortened until the energy falls. */
    RICCI_STEP_ARMIJO = 0,
    /** The largest step that is stable by Gershgorin's bound. */
    RICCI_STEP_STABLE = 1,
    /** Always `step_size`. */
    RICCI_STEP_FIXED = 2,
    /** Barzilai-Borwein's steps as they are; the energy may rise on the way. */
    RICCI_STEP_BARZILAI_BORWEIN = 3
};

/** How a flow is done. Zeroed by ricci_init: the defaults. */
typedef struct ricci_flow_options {
    /** sizeof(ricci_flow_options). */
    size_t size;
    /**
     * RICCI_METHOD_*. Newton's method takes 4 to 7 steps on most surfaces; the gradient flow is for studies
     * of the flow itself.
     */
    uint32_t method;
    /** RICCI_FLIPS_*. Keep the default: without flips triangles can break before the target is reached. */
    uint32_t flips;
    /**
     * Largest |K - target| of a converged metric, radians, positive; 0: 1e-10. The default is met by all but
     * a few flows of docs/results/flow.md; since Newton's last steps double the digits, a larger one saves
     * little.
     */
    double tolerance;
    /**
     * Steps before giving up; 0: 500 for Newton, 200,000 for the gradient flow. The defaults are far above
     * what flows that arrive need (182 in docs/results/flow.md), so a lower limit is a limit of time.
     */
    size_t max_iterations;
    /**
     * Threads of this flow, in a pool of its own; 0: one per core. The result does not depend on it. 1 suits
     * hosts that run several calls at once.
     */
    size_t threads;
    /**
     * Largest change of any u in one Newton step, positive; 0: 3. The default lets lengths change by a factor
     * of e^3 at a time; it seldom needs a change.
     */
    double max_step;
    /**
     * Edges that are not flipped, such as seams and feature lines: rows of ricci_mesh_edges of the mesh that
     * the metric was made from. Targets that only their flips would reach are then out of reach. None suits
     * all but texture seams and features that have to stay edges.
     */
    const uint32_t *fixed_edges;
    /** Entries of `fixed_edges`. 0 with NULL. */
    size_t n_fixed_edges;
    /**
     * RICCI_STEP_*: step rule of the gradient flow. The default needs no tuning; RICCI_STEP_STABLE follows
     * the flow in time.
     */
    uint32_t step;
    /** Gradient flow in E2: 1 keeps the total area of the start. Use it to compare shapes along the flow. */
    uint32_t area_normalised;
    /** The step of RICCI_STEP_FIXED, positive. A trace with RICCI_STEP_STABLE shows how large it may be. */
    double step_size;
} ricci_flow_options;

/**
 * A solver for many targets on one metric. It keeps its symbolic analysis, its threads and the last solution,
 * from which the next solve starts.
 */
typedef struct ricci_solver ricci_solver;

/**
 * The curvature that a target prescribes at every vertex. An inadmissible target is refused. For
 * RICCI_TARGET_OUTER a flow finds the curvature of the boundary.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (kind, no
 * such vertex), RICCI_WRONG_SIZE, RICCI_TARGET_KIND, RICCI_TARGET_AT_VERTEX, RICCI_TARGET_BELOW,
 * RICCI_TARGET_TOTAL, RICCI_FACTORISATION, RICCI_CANCELLED.
 *
 * @param metric      the metric that will flow.
 * @param target      the target; NULL for the default.
 * @param control     progress and cancellation; NULL for neither.
 * @param curvatures  out: n_vertices curvatures, radians.
 * @param capacity    entries of `curvatures`.
 */
RICCI_API ricci_status ricci_target_fill(const ricci_metric *metric, const ricci_target *target,
                                         const ricci_control *control, double *curvatures, size_t capacity);

/**
 * Deform a metric in its conformal class to a prescribed curvature.
 *
 * With flips the result lives on a triangulation of its own, and of a surface with boundary on its double
 * (ricci_metric_mesh); vertices keep their numbers, and layouts lead back. A result that flows again goes
 * on from where it is; if it came of a flow without flips, or with other fixed edges, and edges may be
 * flipped now, it begins at the given lengths.
 *
 * The report says whether the flow came to the target: a flow that stops early returns RICCI_OK, and its
 * `converged` is 0. Inputs are never changed.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT, RICCI_STRUCT_SIZE, RICCI_NO_MEMORY,
 * RICCI_FACTORISATION, RICCI_CANCELLED, and those of ricci_target_fill.
 *
 * @param metric   where the flow starts.
 * @param target   the target; NULL for the default.
 * @param options  the options; NULL for the defaults.
 * @param control  progress and cancellation; NULL for neither.
 * @param result   out: the metric at the end, to be released by ricci_metric_free; its report says how the
 *                 flow ended.
 */
RICCI_API ricci_status ricci_flow(const ricci_metric *metric, const ricci_target *target,
                                  const ricci_flow_options *options, const ricci_control *control,
                                  ricci_metric **result);

/**
 * A solver for many targets.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT, RICCI_STRUCT_SIZE, RICCI_NO_MEMORY,
 * RICCI_FACTORISATION.
 *
 * @param metric   where the first solve starts; it is copied.
 * @param options  the options; NULL for the defaults.
 * @param solver   out: the new handle, to be released by ricci_solver_free.
 */
RICCI_API ricci_status ricci_solver_new(const ricci_metric *metric, const ricci_flow_options *options,
                                        ricci_solver **solver);

/**
 * Release a solver.
 *
 * @param solver  the handle, or NULL.
 */
RICCI_API_VOID void ricci_solver_free(ricci_solver *solver);

/**
 * Hold u fixed at some vertices in the following solves; their curvature is then free.
 *
 * Replaces the vertices that were pinned before. A surface with boundary flows on its double if edges are
 * flipped across the boundary and no vertex is pinned: there the first pin, and the release of all, begin
 * the flow anew from the given lengths.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_POISONED, RICCI_ARGUMENT (no such vertex).
 *
 * @param solver    the solver.
 * @param pinned    n_pinned vertices; NULL if there are none.
 * @param n_pinned  number of vertices; 0 releases all.
 */
RICCI_API ricci_status ricci_solver_pin(ricci_solver *solver, const uint32_t *pinned, size_t n_pinned);

/**
 * ricci_flow from the last solution, with the analysis that the solver keeps.
 *
 * After RICCI_CANCELLED or another failure the solver is where it was before the call.
 * @return as ricci_flow; RICCI_POISONED.
 *
 * @param solver   the solver.
 * @param target   the target; NULL for the default. Curvatures of pinned vertices are ignored.
 * @param control  progress and cancellation; NULL for neither.
 * @param result   out: the metric at the end, to be released by ricci_metric_free.
 */
RICCI_API ricci_status ricci_solver_solve(ricci_solver *solver, const ricci_target *target,
                                          const ricci_control *control, ricci_metric **result);

/* ---------------------------------------------------------------------------------------------------------
 * Reports of the flows that led to metrics
 *
 * Errors at boundary vertices of a surface that was doubled count both copies: they are twice those of the
 * surface.
 */

/** Why a flow stopped. */
enum {
    /** The curvature error is within the tolerance and no triangle is broken. */
    RICCI_STOP_CONVERGED = 0,
    /** The error is as small as rounding allows on this mesh, which is above the tolerance asked for. */
    RICCI_STOP_ROUNDING_FLOOR = 1,
    /** A minimum of the energy with broken triangles: no metric. */
    RICCI_STOP_BROKEN_TRIANGLES = 2,
    /** The variables run away, and no obstruction was found. */
    RICCI_STOP_DIVERGED = 3,
    /** No step lowers the error any more. */
    RICCI_STOP_STALLED = 4,
    /** The iteration limit came first. */
    RICCI_STOP_ITERATION_LIMIT = 5,
    /**
     * No metric of the class on this triangulation has the target curvature: the vertices of
     * RICCI_REPORT_OBSTRUCTION prove it.
     */
    RICCI_STOP_INFEASIBLE = 6,
    /**
     * The step to the target is longer than all steps up to the iteration limit: lengths would differ by a
     * factor beyond use. Spread the curvature over more cones.
     */
    RICCI_STOP_OUT_OF_REACH = 7
};

/** Numbers of a report. */
enum {
    /** n_vertices: the target, curvatures in radians; at pinned vertices the curvature at the end. */
    RICCI_REPORT_TARGET = 0,
    /** n_residuals: largest |K - target| at the start and after every Newton step, radians. */
    RICCI_REPORT_RESIDUALS = 1,
    /** n_trace x 5, of a gradient flow: step, energy, largest |K - target|, area, step size. */
    RICCI_REPORT_TRACE = 2,
    /** n_worst: K - target at the vertices of RICCI_REPORT_WORST, radians. */
    RICCI_REPORT_WORST_ERRORS = 3
};

/** Vertices of a report. */
enum {
    /**
     * n_cones: interior vertices that the target names as cones, or whose curvature it sets off 0 by more
     * than the tolerance. A layout is cut open through them.
     */
    RICCI_REPORT_CONES = 0,
    /** n_worst: the vertices that are farthest from their target, farthest first. */
    RICCI_REPORT_WORST = 1,
    /** n_obstruction: vertices that prove that the target cannot be reached, ascending. */
    RICCI_REPORT_OBSTRUCTION = 2
};

/** Figures of a report. */
typedef struct ricci_report_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** 1 if the curvature error is within `tolerance` and no triangle is broken, else 0. */
    uint32_t converged;
    /** RICCI_STOP_*. */
    uint32_t stop_reason;
    /** Its name, such as "rounding_floor"; lives as long as the program. */
    const char *stop_reason_text;
    /** Number of steps. */
    size_t iterations;
    /** Number of edges flipped by this flow; those before it are in ricci_metric_summary. */
    size_t flips;
    /** Number of triangles whose lengths break the triangle inequality. */
    size_t broken_triangles;
    /** Largest |K - target| over the vertices, radians. */
    double max_curvature_error;
    /** The tolerance that was asked for, radians. */
    double tolerance;
    /**
     * Largest curvature error that rounding can cause at the final metric, radians; determined where a flow
     * stalls, else 0.
     */
    double rounding_floor;
    /** |sum of curvatures + lambda area - 2 pi chi| of the result. */
    double gauss_bonnet;
    /** Seconds in the assembly of curvature and its derivative. */
    double seconds_assemble;
    /** Seconds in the symbolic analysis. */
    double seconds_analyse;
    /** Seconds in numeric factorisations. */
    double seconds_factor;
    /** Seconds in solves. */
    double seconds_solve;
    /** Seconds in edge flips. */
    double seconds_flip;
    /** Seconds in all. */
    double seconds_total;
    /** Entries of RICCI_REPORT_CONES. */
    size_t n_cones;
    /** Entries of RICCI_REPORT_RESIDUALS. */
    size_t n_residuals;
    /** Rows of RICCI_REPORT_TRACE. */
    size_t n_trace;
    /** Entries of RICCI_REPORT_WORST and RICCI_REPORT_WORST_ERRORS. */
    size_t n_worst;
    /** Entries of RICCI_REPORT_OBSTRUCTION; 0 unless the stop reason is RICCI_STOP_INFEASIBLE. */
    size_t n_obstruction;
    /**
     * Total target curvature at the vertices of the obstruction, radians; of a double, with their mirror
     * images.
     */
    double obstruction_target;
    /**
     * Every metric of the class on this triangulation has a total curvature above this at the vertices of
     * the obstruction, radians.
     */
    double obstruction_above;
    /** 1 if u, lengths and curvature were computed in double-double precision (Newton in E2), else 0. */
    uint32_t double_double;
    /** 0. */
    uint32_t reserved;
} ricci_report_summary;

/**
 * The figures of the flow that led to a metric.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (no flow has led to it).
 *
 * @param metric   a metric of a flow, a solver or ricci_uniform_metric.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_report_summarise(const ricci_metric *metric, ricci_report_summary *summary,
                                              size_t size);

/**
 * The target that was asked for, or the course of the flow.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT.
 *
 * @param metric    the metric.
 * @param which     RICCI_REPORT_TARGET, _RESIDUALS, _TRACE or _WORST_ERRORS.
 * @param values    out: the numbers, in the shape that is documented at the constant.
 * @param capacity  entries of `values`.
 */
RICCI_API ricci_status ricci_report_values(const ricci_metric *metric, uint32_t which, double *values,
                                           size_t capacity);

/**
 * The cones, the vertices with the largest errors, or those of the obstruction.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT.
 *
 * @param metric    the metric.
 * @param which     RICCI_REPORT_CONES, _WORST or _OBSTRUCTION.
 * @param vertices  out: the vertices, as many as documented at the constant.
 * @param capacity  entries of `vertices`.
 */
RICCI_API ricci_status ricci_report_vertices(const ricci_metric *metric, uint32_t which, uint32_t *vertices,
                                             size_t capacity);

/* ---------------------------------------------------------------------------------------------------------
 * Layouts
 */

/**
 * The coordinates of a surface that is opened along a cut and unfolded in the space of its metric.
 *
 * The mesh of a layout is the mesh that the metric was made from. If edges were flipped, its faces are cut by
 * the edges of the metric's triangulation: it is the common subdivision, whose faces are parts of faces of
 * both, and whose vertices are those of the mesh, with their numbers, then the crossings of edges of both
 * (ricci_map says where they lie). The map is projective on every piece; RICCI_ON_INPUT makes it linear on
 * the faces of the mesh itself.
 */
typedef struct ricci_layout ricci_layout;

/**
 * Coordinates. The plane is (x, y, 1), the hyperbolic plane x^2 + y^2 - w^2 = -1 with w > 0, the sphere x^2
 * + y^2 + w^2 = 1.
 */
enum {
    /**
     * H2: the unit disk, conformal: (x + i y)/(1 + w). S2: the plane seen from the south pole: (x + i y)/(1
     * + w). E2: (x, y).
     */
    RICCI_MODEL_POINCARE = 0,
    /** H2: the unit disk in which geodesics are straight: (x + i y)/w. Else as POINCARE. */
    RICCI_MODEL_KLEIN = 1,
    /** H2: the upper half-plane, conformal: (-y + i)/(w - x); the disk's centre is i. Else as POINCARE. */
    RICCI_MODEL_HALF_PLANE = 2,
    /** The three coordinates (x, y, w) themselves: they keep their digits however far out. */
    RICCI_MODEL_AMBIENT = 3
};

/** Lengths in a layout in E2; other spaces have a scale of their own. */
enum {
    /** So that the area is that of the surface as it came, in its own geometry. */
    RICCI_SCALE_INPUT_AREA = 0,
    /** As the metric has them. */
    RICCI_SCALE_AS_SOLVED = 1
};

/** Options of a layout. Zeroed by ricci_init: the defaults. */
typedef struct ricci_layout_options {
    /** sizeof(ricci_layout_options). */
    size_t size;
    /**
     * RICCI_MODEL_* with two coordinates: those of ricci_layout_uv and of files. In H2 the default shows
     * angles, RICCI_MODEL_KLEIN straight geodesics.
     */
    uint32_t model;
    /** RICCI_SCALE_*. Patterns to be cut from sheets need RICCI_SCALE_AS_SOLVED, textures the default. */
    uint32_t scale;
    /**
     * Vertices through which the cut has to go; those on the boundary change nothing. NULL with n_cones 0:
     * those of the flow (RICCI_REPORT_CONES), and of a metric without a flow those whose curvature is more
     * than 1e-10 off flat. Not NULL with n_cones 0: none. NULL is right after a flow.
     */
    const uint32_t *cones;
    /** Entries of `cones`. 0 with NULL. */
    size_t n_cones;
    /**
     * The vertex at the origin; NULL: in E2 a corner of the smallest triangle, elsewhere a vertex from which
     * none is far. Name one only to bring layouts of several surfaces into the same place.
     */
    const uint32_t *root;
    /**
     * Threads; 0: as many as the flow had. The result does not depend on it. 1 suits hosts that run several
     * calls at once.
     */
    size_t threads;
} ricci_layout_options;

/** Figures of a layout. */
typedef struct ricci_layout_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** RICCI_SPACE_*. */
    uint32_t space;
    /** RICCI_MODEL_*: the coordinates of ricci_layout_uv. */
    uint32_t model;
    /** V of the layout's mesh: those of the given mesh, then the crossings. */
    size_t n_vertices;
    /** E of the layout's mesh. */
    size_t n_edges;
    /** F of the layout's mesh. */
    size_t n_faces;
    /** V of the mesh that the metric was made from: these vertices come first. */
    size_t n_input_vertices;
    /** F of that mesh. */
    size_t n_input_faces;
    /** Number of points: vertices count once per piece of their star between cuts. */
    size_t n_points;
    /** Number of seams. */
    size_t n_seams;
    /** Number of edges on all seams, on the layout's mesh. */
    size_t n_seam_edges;
    /**
     * Faces that are not counterclockwise: by exact arithmetic; of a common subdivision, those that are
     * clockwise by more than rounding. In H2 orientation is that of the Klein images, whatever the model.
     */
    size_t n_flipped;
    /**
     * Faces of the mesh that are not counterclockwise where the map is made linear on them
     * (RICCI_ON_INPUT): there it folds.
     */
    size_t n_flipped_input;
    /**
     * Faces of the layout's mesh without area in the input or the layout, but for rounding; its distortions
     * below leave them out.
     */
    size_t n_degenerate;
    /**
     * Largest disagreement of an edge vector with the placed points: relative to `diameter` in E2,
     * elsewhere a distance.
     */
    double consistency;
    /** Lengths in the layout over lengths in the metric. */
    double scale;
    /** Area of the surface in the layout. */
    double area;
    /** Diagonal of the bounding box of the points in `model`. */
    double diameter;
    /** Largest distance of a point from the origin, in the space. */
    double radius;
    /**
     * Quasi-conformal dilatation of the faces of the layout's mesh, at least 1: mean over the input's area.
     * NaN, as all below, on the metric's own triangulation.
     */
    double qc_mean;
    /** Largest quasi-conformal dilatation. */
    double qc_max;
    /** Smallest area distortion: share of the layout's area over share of the input's. */
    double area_ratio_min;
    /** Largest area distortion. */
    double area_ratio_max;
    /**
     * The faces without area of the mesh itself, where the map is made linear on them (RICCI_ON_INPUT); the
     * distortions of its faces leave them out.
     */
    size_t n_degenerate_input;
    /**
     * The mean dilatation of the mesh's own faces. NaN, as the three below, where the layout is cut
     * along edges of the metric's triangulation.
     */
    double qc_mean_input;
    /** Largest quasi-conformal dilatation of the mesh's own faces. */
    double qc_max_input;
    /** Smallest area distortion of the mesh's own faces. */
    double area_ratio_min_input;
    /** Largest area distortion of the mesh's own faces. */
    double area_ratio_max_input;
    /**
     * Share of the layout's area that lies on other parts of it, up to rounding: an atlas has no overlaps.
     * NaN outside the plane.
     */
    double overlap;
    /**
     * The symmetric Dirichlet energy: the mean over the input's area of the sum of the squares of the
     * singular values and of their inverses, with both total areas scaled to be the same; 4 for an isometry.
     */
    double symmetric_dirichlet;
} ricci_layout_summary;

/**
 * Lay a metric out in its space.
 *
 * The surface is cut open along edges of the mesh: as little as its topology asks for, and through all
 * cones. The metric should have curvature 0 (E2), -1 (H2) or 1 (S2) at all other vertices, and
 * `consistency` says how far it is. Triangles are counterclockwise where the mesh's are. A closed surface
 * with its deck group: ricci/uniformize.h.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_ARGUMENT (no such vertex;
 * RICCI_MODEL_AMBIENT), RICCI_TRIANGLE_INEQUALITY, RICCI_LAYOUT (a sphere in E2 with fewer than two cones;
 * points too far out for double precision), RICCI_DOMAIN, RICCI_EDGE_WEIGHT, RICCI_TOO_LARGE (the common
 * subdivision), RICCI_NO_MEMORY, RICCI_CANCELLED.
 *
 * @param metric   the metric.
 * @param options  the options; NULL for the defaults.
 * @param control  progress and cancellation; NULL for neither.
 * @param layout   out: the new handle, to be released by ricci_layout_free.
 */
RICCI_API ricci_status ricci_layout_new(const ricci_metric *metric, const ricci_layout_options *options,
                                        const ricci_control *control, ricci_layout **layout);

/**
 * Release a layout.
 *
 * @param layout  the handle, or NULL.
 */
RICCI_API_VOID void ricci_layout_free(ricci_layout *layout);

/**
 * The figures of a layout.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param layout   the layout.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_layout_summarise(const ricci_layout *layout, ricci_layout_summary *summary,
                                              size_t size);

/**
 * The points of the layout.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT.
 *
 * @param layout    the layout.
 * @param model     RICCI_MODEL_*.
 * @param points    out: n_points x 2; n_points x 3 for RICCI_MODEL_AMBIENT.
 * @param capacity  entries of `points`.
 */
RICCI_API ricci_status ricci_layout_points(const ricci_layout *layout, uint32_t model, double *points,
                                           size_t capacity);

/**
 * The point of every corner of every face: as OBJ's `vt` indices, but 0-based.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT, RICCI_LAYOUT
 * (RICCI_ON_INPUT of ricci_uniform_layout, which is cut along edges of the metric's triangulation).
 *
 * @param layout    the layout.
 * @param on        RICCI_ON_INPUT: the faces of the given mesh; else those of the layout's mesh.
 * @param corners   out: n_input_faces x 3 or n_faces x 3 indices of points.
 * @param capacity  entries of `corners`.
 */
RICCI_API ricci_status ricci_layout_corners(const ricci_layout *layout, uint32_t on, uint32_t *corners,
                                            size_t capacity);

/**
 * The coordinates of every corner of every face, in the layout's model.
 *
 * On the input the map is made linear on each face; where that folds faces, the summary's n_flipped_input
 * counts them.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT, RICCI_LAYOUT (as of
 * ricci_layout_corners).
 *
 * @param layout    the layout.
 * @param on        RICCI_ON_INPUT: the corners of the mesh, in the order of its faces; else those of the
 *                  layout's mesh.
 * @param uv        out: n_input_faces x 3 x 2 or n_faces x 3 x 2.
 * @param capacity  entries of `uv`.
 */
RICCI_API ricci_status ricci_layout_uv(const ricci_layout *layout, uint32_t on, double *uv, size_t capacity);

/**
 * The isometry that carries the left side of every seam onto its right side, as a Moebius transformation z
 * -> (a z + b)/(c z + d): in the plane (E2: a = exp(i theta), b the translation, c = 0, d = 1), the
 * Poincare disk or the plane under the sphere.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL.
 *
 * @param layout    the layout.
 * @param seams     out: n_seams x 9: real and imaginary parts of a, b, c, d, and how far the edges of the
 *                  seam are from it: relative to the diameter in E2, elsewhere a distance.
 * @param capacity  entries of `seams`, at least 9 n_seams.
 */
RICCI_API ricci_status ricci_layout_seams(const ricci_layout *layout, double *seams, size_t capacity);

/**
 * The edges of every seam, in order.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT, RICCI_LAYOUT (as of
 * ricci_layout_corners).
 *
 * @param layout           the layout.
 * @param on               RICCI_ON_INPUT: edges of the given mesh; else of the layout's mesh.
 * @param edges            out: edge numbers, 1-based, negative where the seam runs against the edge's
 *                         direction; seam after seam. On the layout's mesh there are n_seam_edges.
 * @param edges_capacity   entries of `edges`.
 * @param starts           out: n_seams + 1 offsets: seam i is edges[starts[i] .. starts[i + 1]).
 * @param starts_capacity  entries of `starts`.
 */
RICCI_API ricci_status ricci_layout_seam_edges(const ricci_layout *layout, uint32_t on, int32_t *edges,
                                               size_t edges_capacity, size_t *starts, size_t starts_capacity);

/**
 * The faces that are not counterclockwise, as n_flipped_input and n_flipped count them.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT, RICCI_LAYOUT (as of
 * ricci_layout_corners).
 *
 * @param layout    the layout.
 * @param on        RICCI_ON_INPUT: faces of the given mesh; else of the layout's mesh.
 * @param faces     out: face indices, ascending.
 * @param capacity  entries of `faces`.
 */
RICCI_API ricci_status ricci_layout_flipped(const ricci_layout *layout, uint32_t on, uint32_t *faces,
                                            size_t capacity);

/**
 * The distortion of every face.
 *
 * On the input it is the map that is linear on each face of the mesh, whose coordinates ricci_layout_uv
 * gives there; a face that folds has the dilatation of its mirror image. Shares are of the sum over all
 * faces. A face without area on either side has the dilatation 1 / DBL_EPSILON; no number is larger.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT, RICCI_NO_MEMORY,
 * RICCI_LAYOUT (RICCI_ON_INPUT as of ricci_layout_corners; else the metric's own triangulation after
 * flips).
 *
 * @param layout      the layout.
 * @param on          RICCI_ON_INPUT: the faces of the given mesh; else those of the layout's mesh.
 * @param qc          out: n_input_faces or n_faces quasi-conformal dilatations, at least 1: 1 is conformal.
 * @param area_ratio  out: as many shares of the layout's area over shares of the input's.
 * @param capacity    entries of `qc` and of `area_ratio`.
 */
RICCI_API ricci_status ricci_layout_distortion(const ricci_layout *layout, uint32_t on, double *qc,
                                               double *area_ratio, size_t capacity);

/**
 * The mesh of the layout: the mesh that the metric was made from, or the common subdivision.
 *
 * The given vertices come first, where they were bit for bit; crossings lie on the edges of the given mesh.
 * Of an intrinsic surface the mesh has the lengths of the layout. Crossings may be so near to others that
 * they coincide: RICCI_LENGTHS of it is then refused.
 * @return RICCI_OK, RICCI_NULL_POINTER.
 *
 * @param layout  the layout.
 * @param mesh    out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_layout_mesh(const ricci_layout *layout, ricci_mesh **mesh);

/**
 * Write a mesh with the layout as texture coordinates, in the format of the file's extension: .obj
 * (`f v/vt`), .ply and .off, whose numbers read back as they are, or .glb, which has 24 bits.
 *
 * On the input: its own vertices and faces, in order; seams run along its edges only. On the common
 * subdivision the `v` of the mesh come first, unchanged, then the crossings. A file of that name is replaced
 * only once the new one is complete.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_UNKNOWN_FORMAT, RICCI_ARGUMENT (the mesh is
 * intrinsic; a layout with seams as .off, which has no place for them; `homogeneous` as another format than
 * .obj), RICCI_DOMAIN, RICCI_LAYOUT (as of ricci_layout_corners; a model that is not projective).
 *
 * @param layout       the layout.
 * @param on           RICCI_ON_INPUT: the given mesh; else the layout's mesh.
 * @param homogeneous  1: `vt qx qy q` with the q of ricci_map_weights: the projective map of every piece is
 *                     linear in these three, and divided by the third; in H2 in the Klein disk alone, not
 *                     on the input. 0: `vt x y`.
 * @param path         file name in UTF-8, ending in .obj, .off, .ply or .glb.
 */
RICCI_API ricci_status ricci_layout_write(const ricci_layout *layout, uint32_t on, uint32_t homogeneous,
                                          const char *path);

/** The layers of the lines of a layout in the plane, and their names in files: BOUNDARY, SEAMS, FOLDS,
 * ALLOWANCE. */
enum {
    /** The boundary of the surface. */
    RICCI_LAYER_BOUNDARY = 0,
    /** A side of a seam; the other side is another line. */
    RICCI_LAYER_SEAMS = 1,
    /** An edge of the given mesh along which the surface in space has a crease. */
    RICCI_LAYER_FOLDS = 2,
    /** A line outside the border for sewing, which the command draws; layouts have none. */
    RICCI_LAYER_ALLOWANCE = 3
};

/** The unit of coordinates, for the size of an SVG drawing. */
enum {
    /** Millimetres. */
    RICCI_SHEET_MILLIMETRE = 0,
    /** Centimetres. */
    RICCI_SHEET_CENTIMETRE = 1,
    /** Metres. */
    RICCI_SHEET_METRE = 2,
    /** Inches of 25.4 mm. */
    RICCI_SHEET_INCH = 3
};

/**
 * The lines along which a layout in E2 is cut and folded: its outline, with the surface on the left, divided
 * into lines of the boundary and of the sides of seams; then the folds. A loop of the boundary that no seam
 * meets is one closed line.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT, RICCI_LAYOUT (as of
 * ricci_layout_corners; not in the plane).
 *
 * @param layout      the layout.
 * @param on          RICCI_ON_INPUT: along edges of the given mesh; else of the layout's mesh.
 * @param fold_angle  edges are folds where the normals of their faces differ by more than this, radians, 0 to
 *                    pi; an intrinsic mesh has no folds.
 * @param lines       out: four numbers for each line: RICCI_LAYER_*, the number of the seam or -1, 1 if the
 *                    line is closed, the number of its points.
 * @param capacity    entries of `lines`.
 */
RICCI_API ricci_status ricci_layout_lines(const ricci_layout *layout, uint32_t on, double fold_angle,
                                          int32_t *lines, size_t capacity);

/**
 * The points along the lines of ricci_layout_lines, line after line, as indices into ricci_layout_points. A
 * closed line does not repeat its first point.
 *
 * @return as of ricci_layout_lines.
 *
 * @param layout      the layout.
 * @param on          as of ricci_layout_lines.
 * @param fold_angle  as of ricci_layout_lines.
 * @param points      out: as many indices as the lines have points together.
 * @param capacity    entries of `points`.
 */
RICCI_API ricci_status ricci_layout_line_points(const ricci_layout *layout, uint32_t on, double fold_angle,
                                                uint32_t *points, size_t capacity);

/**
 * Write a layout in E2 as geometry: its mesh with points (x, y, 0), .obj, .off, .ply or .glb; or the lines of
 * ricci_layout_lines as a drawing with a layer for each RICCI_LAYER_*, .svg (true to size) or .dxf (R12).
 *
 * A layout with RICCI_SCALE_AS_SOLVED has the lengths of the metric. A file of that name is replaced only
 * once the new one is complete.
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_IO, RICCI_ARGUMENT, RICCI_DOMAIN, RICCI_UNKNOWN_FORMAT,
 * RICCI_LAYOUT (as of ricci_layout_lines).
 *
 * @param layout      the layout.
 * @param on          RICCI_ON_INPUT: the given mesh; else the layout's mesh.
 * @param fold_angle  as of ricci_layout_lines.
 * @param unit        RICCI_SHEET_*: the unit of the coordinates.
 * @param path        file name in UTF-8.
 */
RICCI_API ricci_status ricci_layout_write_flat(const ricci_layout *layout, uint32_t on, double fold_angle,
                                               uint32_t unit, const char *path);

/* ---------------------------------------------------------------------------------------------------------
 * Maps: the common subdivision of the mesh and the metric's triangulation, which carries values from one to
 * the other
 */

/**
 * The map between the mesh that a metric was made from and the metric's triangulation, given by their common
 * subdivision; or between two surfaces that were matched (ricci_matching_map in ricci/match.h).
 *
 * Its faces are parts of faces of both; its vertices are those of the mesh, with their numbers, then the
 * crossings of edges. If no edge was flipped it is the mesh itself. Layouts of the metric have its vertices
 * and faces.
 */
typedef struct ricci_map ricci_map;

/** The places at which values are given. */
enum {
    /** One row per vertex; linear along edges. */
    RICCI_AT_VERTICES = 0,
    /**
     * Three rows per face, one for each corner; linear in every face: texture coordinates, normals with
     * creases.
     */
    RICCI_AT_CORNERS = 1
};

/** Figures of a map. */
typedef struct ricci_map_summary {
    /** Bytes of this struct that are filled. */
    size_t size;
    /** V of the common subdivision: those of the mesh, then n_crossings. */
    size_t n_vertices;
    /** E of the common subdivision. */
    size_t n_edges;
    /** F of the common subdivision. */
    size_t n_faces;
    /**
     * Vertices where an edge of the mesh and one of the metric's triangulation cross; 0 if no edge was
     * flipped.
     */
    size_t n_crossings;
    /**
     * Number of pieces: a piece is the intersection of a face of the mesh and one of the metric's
     * triangulation, cut into triangles.
     */
    size_t n_pieces;
} ricci_map_summary;

/** Values of the caller that a map carries. Zeroed by ricci_init. */
typedef struct ricci_carried {
    /** sizeof(ricci_carried). */
    size_t size;
    /** RICCI_ON_INPUT: of the mesh; RICCI_ON_METRIC: of the metric's triangulation, with its lengths. */
    uint32_t on;
    /** RICCI_AT_*. */
    uint32_t at;
    /** n_values x n_components (vertices) or n_values x 3 x n_components (corners), row by row; finite. */
    const double *values;
    /** Number of vertices or faces there. */
    size_t n_values;
    /** Numbers per vertex or corner, such as 3 of a normal. */
    size_t n_components;
} ricci_carried;

/**
 * The map of a metric.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_DOMAIN, RICCI_EDGE_WEIGHT, RICCI_TOO_LARGE, RICCI_NO_MEMORY,
 * RICCI_CANCELLED.
 *
 * @param metric   the metric.
 * @param control  progress and cancellation; NULL for neither.
 * @param map      out: the new handle, to be released by ricci_map_free.
 */
RICCI_API ricci_status ricci_map_new(const ricci_metric *metric, const ricci_control *control,
                                     ricci_map **map);

/**
 * Release a map.
 *
 * @param map  the handle, or NULL.
 */
RICCI_API_VOID void ricci_map_free(ricci_map *map);

/**
 * The figures of a map.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE.
 *
 * @param map      the map.
 * @param summary  out: the figures.
 * @param size     sizeof *summary.
 */
RICCI_API ricci_status ricci_map_summarise(const ricci_map *map, ricci_map_summary *summary, size_t size);

/**
 * The common subdivision in space: the given vertices first, where they were, then the crossings on the edges
 * of the given mesh.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_ARGUMENT (the given mesh is intrinsic: ricci_layout_mesh).
 *
 * @param map   the map.
 * @param mesh  out: the new handle, to be released by ricci_mesh_free.
 */
RICCI_API ricci_status ricci_map_mesh(const ricci_map *map, ricci_mesh **mesh);

/**
 * The face that every face of the common subdivision is part of.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT.
 *
 * @param map       the map.
 * @param on        RICCI_ON_INPUT: faces of the mesh; RICCI_ON_METRIC: of ricci_metric_mesh;
 *                  RICCI_ON_REFINEMENT: pieces, from 0. Faces of a piece have consecutive numbers and one
 *                  projective map.
 * @param faces     out: n_faces face indices.
 * @param capacity  entries of `faces`.
 */
RICCI_API ricci_status ricci_map_faces(const ricci_map *map, uint32_t on, uint32_t *faces, size_t capacity);

/**
 * The barycentric coordinates of the corners of every face of the common subdivision in the face that it is
 * part of: values at the corners of that face, added up with these weights, are the values there.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT.
 *
 * @param map       the map.
 * @param on        RICCI_ON_INPUT: in its face of the mesh; RICCI_ON_METRIC: of the metric's triangulation,
 *                  with its lengths.
 * @param weights   out: n_faces x 3 x 3 barycentric coordinates [face, corner, corner of the other face].
 * @param capacity  entries of `weights`, at least 9 n_faces.
 */
RICCI_API ricci_status ricci_map_barycentric(const ricci_map *map, uint32_t on, double *weights,
                                             size_t capacity);

/**
 * The places of the crossings: vertex n_vertices of the mesh + k lies at end 0 (1 - t) + end 1 t of its edge.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_ARGUMENT.
 *
 * @param map        the map.
 * @param on         RICCI_ON_INPUT: on edges of the mesh; RICCI_ON_METRIC: of the metric's triangulation,
 *                   with its lengths.
 * @param edges      out: n_crossings rows of ricci_mesh_edges of that mesh.
 * @param fractions  out: n_crossings numbers t, from 0 to 1.
 * @param capacity   entries of `edges` and of `fractions`.
 */
RICCI_API ricci_status ricci_map_crossings(const ricci_map *map, uint32_t on, uint32_t *edges,
                                           double *fractions, size_t capacity);

/**
 * The homogeneous weight q of every vertex of the common subdivision. In a piece the map from the mesh to a
 * layout in the plane is projective, and with (x, y) the point of a corner it is (q x, q y, q) that is
 * linear: as texture coordinates of three components.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_BUFFER_TOO_SMALL, RICCI_DOMAIN.
 *
 * @param map       the map.
 * @param weights   out: n_vertices weights, positive; only their quotients in a piece mean anything. In H2
 *                  and S2 it is q times ambient coordinates that is linear.
 * @param capacity  entries of `weights`.
 */
RICCI_API ricci_status ricci_map_weights(const ricci_map *map, double *weights, size_t capacity);

/**
 * Carry values at vertices or corners, of the mesh or of the metric's triangulation, to those of the common
 * subdivision. At given vertices they stay as they are.
 *
 * @return RICCI_OK, RICCI_NULL_POINTER, RICCI_STRUCT_SIZE, RICCI_WRONG_SIZE, RICCI_ARGUMENT (a value is not
 * finite), RICCI_TOO_LARGE, RICCI_NO_MEMORY, RICCI_BUFFER_TOO_SMALL.
 *
 * @param map       the map.
 * @param values    the values.
 * @param carried   out: n_vertices x n_components or n_faces x 3 x n_components.
 * @param capacity  entries of `carried`.
 */
RICCI_API ricci_status ricci_map_carry(const ricci_map *map, const ricci_carried *values, double *carried,
                                       size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
