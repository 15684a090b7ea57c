/* ricci/ricci.h as programs of version 0.1 were compiled with it, without its comments. It is never changed.
 */
#ifndef RICCI_H
#define RICCI_H
#include <stddef.h>
#include <stdint.h>
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
#ifdef __cplusplus
extern "C" {
#endif
#define RICCI_VERSION_MAJOR 0
#define RICCI_VERSION_MINOR 1
#define RICCI_VERSION_PATCH 0
#define RICCI_VERSION (1000000 * RICCI_VERSION_MAJOR + 1000 * RICCI_VERSION_MINOR + RICCI_VERSION_PATCH)
typedef uint32_t ricci_status;
enum {
    RICCI_OK = 0,
    RICCI_WRONG_SIZE = 1,
    RICCI_ARGUMENT = 2,
    RICCI_TOO_LARGE = 3,
    RICCI_CANCELLED = 4,
    RICCI_NULL_POINTER = 10,
    RICCI_PANIC = 11,
    RICCI_POISONED = 12,
    RICCI_BUFFER_TOO_SMALL = 13,
    RICCI_STRUCT_SIZE = 14,
    RICCI_NO_MEMORY = 15,
    RICCI_IO = 100,
    RICCI_PARSE = 101,
    RICCI_UNKNOWN_FORMAT = 102,
    RICCI_DEFECTS = 200,
    RICCI_GLUING = 201,
    RICCI_CONNECTIVITY = 202,
    RICCI_EDGE_LENGTH = 300,
    RICCI_TRIANGLE_INEQUALITY = 301,
    RICCI_EDGE_WEIGHT = 302,
    RICCI_DOMAIN = 303,
    RICCI_TARGET_AT_VERTEX = 400,
    RICCI_TARGET_TOTAL = 401,
    RICCI_TARGET_KIND = 402,
    RICCI_TARGET_BELOW = 403,
    RICCI_FACTORISATION = 500,
    RICCI_LAYOUT = 600
};
enum {
    RICCI_ELEMENT_NONE = 0,
    RICCI_ELEMENT_VERTEX = 1,
    RICCI_ELEMENT_EDGE = 2,
    RICCI_ELEMENT_FACE = 3,
    RICCI_ELEMENT_ENTRY = 4,
    RICCI_ELEMENT_LINE = 5,
    RICCI_ELEMENT_BYTE = 6
};
typedef struct ricci_failure {
    size_t size;
    ricci_status status;
    uint32_t element;
    int64_t index;
    double amount;
    size_t needed;
} ricci_failure;
RICCI_API const char *ricci_version(void);
RICCI_API uint32_t ricci_version_number(void);
RICCI_API const char *ricci_status_text(ricci_status status);
RICCI_API const char *ricci_last_error(void);
RICCI_API ricci_status ricci_last_failure(ricci_failure *failure, size_t size);
RICCI_API ricci_status ricci_init(void *options, size_t size);
enum {
    RICCI_LOG_OFF = 0,
    RICCI_LOG_ERROR = 1,
    RICCI_LOG_WARN = 2,
    RICCI_LOG_INFO = 3,
    RICCI_LOG_DEBUG = 4,
    RICCI_LOG_TRACE = 5
};
typedef void (*ricci_log_callback)(uint32_t level, const char *message, void *user_data);
RICCI_API ricci_status ricci_log_set(ricci_log_callback callback, void *user_data, uint32_t level);
typedef struct ricci_control ricci_control;
enum {
    RICCI_STAGE_IDLE = 0,
    RICCI_STAGE_READ = 1,
    RICCI_STAGE_BUILD = 2,
    RICCI_STAGE_FLOW = 3,
    RICCI_STAGE_LAYOUT = 4,
    RICCI_STAGE_WRITE = 5
};
RICCI_API ricci_status ricci_control_new(ricci_control **control);
RICCI_API_VOID void ricci_control_free(ricci_control *control);
RICCI_API ricci_status ricci_control_cancel(const ricci_control *control);
RICCI_API ricci_status ricci_control_progress(const ricci_control *control, uint32_t *stage, double *fraction,
                                              double *since_cancel);
typedef struct ricci_mesh ricci_mesh;
enum { RICCI_SPACE_E2 = 0, RICCI_SPACE_H2 = 1, RICCI_SPACE_S2 = 2 };
enum {
    RICCI_POSITIONS = 0,
    RICCI_LENGTHS = 1,
    RICCI_NORMALS = 2,
    RICCI_COLORS = 3,
    RICCI_UV = 4,
    RICCI_CORNER_NORMALS = 5
};
typedef struct ricci_mesh_summary {
    size_t size;
    size_t n_vertices;
    size_t n_edges;
    size_t n_faces;
    size_t n_boundary_loops;
    size_t n_boundary_vertices;
    int64_t euler;
    size_t genus;
    uint32_t has_positions;
    uint32_t geometry;
    size_t n_normals;
    size_t n_colors;
    size_t n_uv;
    size_t n_corner_normals;
} ricci_mesh_summary;
typedef struct ricci_gluing {
    size_t size;
    size_t n_vertices;
    const uint32_t *faces;
    const int32_t *face_edges;
    size_t n_faces;
    const double *lengths;
    size_t n_edges;
    uint32_t geometry;
    uint32_t reserved;
} ricci_gluing;
typedef struct ricci_attributes {
    size_t size;
    const double *normals;
    const double *colors;
    const double *uv;
    const double *corner_normals;
    const uint8_t *png;
    size_t png_size;
    uint32_t wrap;
    uint32_t reserved;
} ricci_attributes;
enum { RICCI_WRAP_REPEAT = 0, RICCI_WRAP_MIRROR = 1, RICCI_WRAP_CLAMP = 2 };
RICCI_API ricci_status ricci_mesh_from_arrays(const double *positions, size_t stride, size_t n_vertices,
                                              const uint32_t *faces, size_t n_faces, ricci_mesh **mesh);
RICCI_API ricci_status ricci_mesh_from_gluing(const ricci_gluing *gluing, ricci_mesh **mesh);
RICCI_API ricci_status ricci_mesh_with_lengths(const ricci_mesh *mesh, const double *lengths, size_t n_edges,
                                               uint32_t geometry, ricci_mesh **result);
RICCI_API ricci_status ricci_mesh_read(const char *path, ricci_mesh **mesh);
RICCI_API ricci_status ricci_mesh_write(const ricci_mesh *mesh, const ricci_attributes *attributes,
                                        const char *path);
RICCI_API_VOID void ricci_mesh_free(ricci_mesh *mesh);
RICCI_API ricci_status ricci_mesh_summarise(const ricci_mesh *mesh, ricci_mesh_summary *summary, size_t size);
RICCI_API ricci_status ricci_mesh_values(const ricci_mesh *mesh, uint32_t which, double *values,
                                         size_t capacity);
RICCI_API ricci_status ricci_mesh_faces(const ricci_mesh *mesh, uint32_t *faces, size_t capacity);
RICCI_API ricci_status ricci_mesh_edges(const ricci_mesh *mesh, uint32_t *edges, size_t capacity);
RICCI_API ricci_status ricci_mesh_face_edges(const ricci_mesh *mesh, int32_t *face_edges, size_t capacity);
RICCI_API ricci_status ricci_mesh_boundary(const ricci_mesh *mesh, uint32_t *vertices,
                                           size_t vertices_capacity, size_t *starts, size_t starts_capacity);
typedef struct ricci_metric ricci_metric;
enum {
    RICCI_SCHEME_YAMABE = 0,
    RICCI_SCHEME_INVERSIVE = 1,
    RICCI_SCHEME_THURSTON = 2,
    RICCI_SCHEME_TANGENTIAL = 3,
    RICCI_SCHEME_VIRTUAL = 4
};
enum { RICCI_ON_INPUT = 0, RICCI_ON_METRIC = 1, RICCI_ON_REFINEMENT = 2 };
enum {
    RICCI_METRIC_FACTOR = 0,
    RICCI_METRIC_CURVATURE = 1,
    RICCI_METRIC_U = 2,
    RICCI_METRIC_TYPE = 3,
    RICCI_METRIC_LENGTH = 4,
    RICCI_METRIC_ETA = 5,
    RICCI_METRIC_MESH_U = 6
};
typedef struct ricci_metric_summary {
    size_t size;
    uint32_t space;
    uint32_t input_geometry;
    uint32_t scheme;
    uint32_t doubled;
    size_t n_vertices;
    size_t n_mesh_vertices;
    size_t n_edges;
    size_t n_faces;
    double area;
    double gauss_bonnet;
    size_t broken_triangles;
    size_t clamped_edges;
    double max_length_change;
    size_t n_flips;
    size_t n_start_flips;
} ricci_metric_summary;
RICCI_API ricci_status ricci_metric_new(const ricci_mesh *mesh, uint32_t scheme, uint32_t space,
                                        ricci_metric **metric);
RICCI_API_VOID void ricci_metric_free(ricci_metric *metric);
RICCI_API ricci_status ricci_metric_summarise(const ricci_metric *metric, ricci_metric_summary *summary,
                                              size_t size);
RICCI_API ricci_status ricci_metric_values(const ricci_metric *metric, uint32_t which, double *values,
                                           size_t capacity);
RICCI_API ricci_status ricci_metric_mesh(const ricci_metric *metric, ricci_mesh **mesh);
RICCI_API ricci_status ricci_metric_mirror(const ricci_metric *metric, uint32_t *mirror, size_t capacity);
enum {
    RICCI_TARGET_DEFAULT = 0,
    RICCI_TARGET_UNIFORM = 1,
    RICCI_TARGET_BOUNDARY = 2,
    RICCI_TARGET_SINGLE = 3,
    RICCI_TARGET_CONES = 4,
    RICCI_TARGET_AUTO = 5,
    RICCI_TARGET_GIVEN = 6
};
typedef struct ricci_target {
    size_t size;
    uint32_t kind;
    uint32_t reserved;
    size_t n;
    const uint32_t *vertices;
    const double *curvatures;
} ricci_target;
enum { RICCI_METHOD_NEWTON = 0, RICCI_METHOD_GRADIENT = 1 };
enum { RICCI_FLIPS_AUTO = 0, RICCI_FLIPS_NEVER = 1 };
enum { RICCI_STEP_BARZILAI_BORWEIN = 0, RICCI_STEP_STABLE = 1, RICCI_STEP_FIXED = 2 };
typedef struct ricci_flow_options {
    size_t size;
    uint32_t method;
    uint32_t flips;
    double tolerance;
    size_t max_iterations;
    size_t threads;
    double max_step;
    const uint32_t *fixed_edges;
    size_t n_fixed_edges;
    uint32_t step;
    uint32_t area_normalised;
    double step_size;
} ricci_flow_options;
typedef struct ricci_solver ricci_solver;
RICCI_API ricci_status ricci_target_fill(const ricci_metric *metric, const ricci_target *target,
                                         const ricci_control *control, double *curvatures, size_t capacity);
RICCI_API ricci_status ricci_flow(const ricci_metric *metric, const ricci_target *target,
                                  const ricci_flow_options *options, const ricci_control *control,
                                  ricci_metric **result);
RICCI_API ricci_status ricci_solver_new(const ricci_metric *metric, const ricci_flow_options *options,
                                        ricci_solver **solver);
RICCI_API_VOID void ricci_solver_free(ricci_solver *solver);
RICCI_API ricci_status ricci_solver_pin(ricci_solver *solver, const uint32_t *pinned, size_t n_pinned);
RICCI_API ricci_status ricci_solver_solve(ricci_solver *solver, const ricci_target *target,
                                          const ricci_control *control, ricci_metric **result);
enum {
    RICCI_STOP_CONVERGED = 0,
    RICCI_STOP_ROUNDING_FLOOR = 1,
    RICCI_STOP_BROKEN_TRIANGLES = 2,
    RICCI_STOP_DIVERGED = 3,
    RICCI_STOP_STALLED = 4,
    RICCI_STOP_ITERATION_LIMIT = 5,
    RICCI_STOP_INFEASIBLE = 6
};
enum {
    RICCI_REPORT_TARGET = 0,
    RICCI_REPORT_RESIDUALS = 1,
    RICCI_REPORT_TRACE = 2,
    RICCI_REPORT_WORST_ERRORS = 3
};
enum { RICCI_REPORT_CONES = 0, RICCI_REPORT_WORST = 1, RICCI_REPORT_OBSTRUCTION = 2 };
typedef struct ricci_report_summary {
    size_t size;
    uint32_t converged;
    uint32_t stop_reason;
    const char *stop_reason_text;
    size_t iterations;
    size_t flips;
    size_t broken_triangles;
    double max_curvature_error;
    double tolerance;
    double rounding_floor;
    double gauss_bonnet;
    double seconds_assemble;
    double seconds_analyse;
    double seconds_factor;
    double seconds_solve;
    double seconds_flip;
    double seconds_total;
    size_t n_cones;
    size_t n_residuals;
    size_t n_trace;
    size_t n_worst;
    size_t n_obstruction;
    double obstruction_target;
    double obstruction_above;
    uint32_t double_double;
    uint32_t reserved;
} ricci_report_summary;
RICCI_API ricci_status ricci_report_summarise(const ricci_metric *metric, ricci_report_summary *summary,
                                              size_t size);
RICCI_API ricci_status ricci_report_values(const ricci_metric *metric, uint32_t which, double *values,
                                           size_t capacity);
RICCI_API ricci_status ricci_report_vertices(const ricci_metric *metric, uint32_t which, uint32_t *vertices,
                                             size_t capacity);
typedef struct ricci_layout ricci_layout;
enum { RICCI_MODEL_POINCARE = 0, RICCI_MODEL_KLEIN = 1, RICCI_MODEL_HALF_PLANE = 2, RICCI_MODEL_AMBIENT = 3 };
enum { RICCI_SCALE_INPUT_AREA = 0, RICCI_SCALE_AS_SOLVED = 1 };
typedef struct ricci_layout_options {
    size_t size;
    uint32_t model;
    uint32_t scale;
    const uint32_t *cones;
    size_t n_cones;
    const uint32_t *root;
    size_t threads;
} ricci_layout_options;
typedef struct ricci_layout_summary {
    size_t size;
    uint32_t space;
    uint32_t model;
    size_t n_vertices;
    size_t n_edges;
    size_t n_faces;
    size_t n_input_vertices;
    size_t n_input_faces;
    size_t n_points;
    size_t n_seams;
    size_t n_seam_edges;
    size_t n_flipped;
    size_t n_flipped_input;
    size_t n_degenerate;
    double consistency;
    double scale;
    double area;
    double diameter;
    double radius;
    double qc_mean;
    double qc_max;
    double area_ratio_min;
    double area_ratio_max;
} ricci_layout_summary;
RICCI_API ricci_status ricci_layout_new(const ricci_metric *metric, const ricci_layout_options *options,
                                        const ricci_control *control, ricci_layout **layout);
RICCI_API_VOID void ricci_layout_free(ricci_layout *layout);
RICCI_API ricci_status ricci_layout_summarise(const ricci_layout *layout, ricci_layout_summary *summary,
                                              size_t size);
RICCI_API ricci_status ricci_layout_points(const ricci_layout *layout, uint32_t model, double *points,
                                           size_t capacity);
RICCI_API ricci_status ricci_layout_corners(const ricci_layout *layout, uint32_t on, uint32_t *corners,
                                            size_t capacity);
RICCI_API ricci_status ricci_layout_uv(const ricci_layout *layout, uint32_t on, double *uv, size_t capacity);
RICCI_API ricci_status ricci_layout_seams(const ricci_layout *layout, double *seams, size_t capacity);
RICCI_API ricci_status ricci_layout_seam_edges(const ricci_layout *layout, uint32_t on, int32_t *edges,
                                               size_t edges_capacity, size_t *starts, size_t starts_capacity);
RICCI_API ricci_status ricci_layout_flipped(const ricci_layout *layout, uint32_t on, uint32_t *faces,
                                            size_t capacity);
RICCI_API ricci_status ricci_layout_distortion(const ricci_layout *layout, double *qc, double *area_ratio,
                                               size_t capacity);
RICCI_API ricci_status ricci_layout_mesh(const ricci_layout *layout, ricci_mesh **mesh);
RICCI_API ricci_status ricci_layout_write(const ricci_layout *layout, uint32_t on, uint32_t homogeneous,
                                          const char *path);
typedef struct ricci_map ricci_map;
enum { RICCI_AT_VERTICES = 0, RICCI_AT_CORNERS = 1 };
typedef struct ricci_map_summary {
    size_t size;
    size_t n_vertices;
    size_t n_edges;
    size_t n_faces;
    size_t n_crossings;
    size_t n_pieces;
} ricci_map_summary;
typedef struct ricci_carried {
    size_t size;
    uint32_t on;
    uint32_t at;
    const double *values;
    size_t n_values;
    size_t n_components;
} ricci_carried;
RICCI_API ricci_status ricci_map_new(const ricci_metric *metric, const ricci_control *control,
                                     ricci_map **map);
RICCI_API_VOID void ricci_map_free(ricci_map *map);
RICCI_API ricci_status ricci_map_summarise(const ricci_map *map, ricci_map_summary *summary, size_t size);
RICCI_API ricci_status ricci_map_mesh(const ricci_map *map, ricci_mesh **mesh);
RICCI_API ricci_status ricci_map_faces(const ricci_map *map, uint32_t on, uint32_t *faces, size_t capacity);
RICCI_API ricci_status ricci_map_barycentric(const ricci_map *map, uint32_t on, double *weights,
                                             size_t capacity);
RICCI_API ricci_status ricci_map_crossings(const ricci_map *map, uint32_t on, uint32_t *edges,
                                           double *fractions, size_t capacity);
RICCI_API ricci_status ricci_map_weights(const ricci_map *map, double *weights, size_t capacity);
RICCI_API ricci_status ricci_map_carry(const ricci_map *map, const ricci_carried *values, double *carried,
                                       size_t capacity);
#ifdef __cplusplus
}
#endif
#endif
