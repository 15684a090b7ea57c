// CHOLMOD (supernodal) and Eigen's SimplicialLDLT on the matrix of a file: seconds of one analysis,
// factorisation and solve, and the residual that shows which system was solved.
//
//   peers                  what the libraries are
//   peers MATRIX SOLVER    one of "CHOLMOD AMD", "CHOLMOD METIS", "Eigen LDLT": analyse, factor, solve
//   (seconds), numbers
//                          in the factor, processor seconds per second of the factorisation, |A x - b|
//
// One solver per process: the threads of a BLAS go on spinning for a while after it is done and would disturb
// the next.
//
// MATRIX, in the machine's byte order: n, k (u64); n + 1 column starts (i32); k rows (i32); k values (f64):
// the lower triangle of a positive definite matrix by columns, rows ascending. The right-hand side is 1, -1,
// 1, -1, ...
//
// The matrix comes in a file, from benches/flow, because the C face keeps the derivative of the curvature to
// itself: so the bench can give faer and the peers the same numbers, and nothing under the GPL shares a
// process with ricci.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <dlfcn.h>
#include <Eigen/CholmodSupport>
#include <Eigen/SparseCholesky>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
using Lower = Eigen::Map<const Matrix>;
using Vector = Eigen::VectorXd;

// The arrays of a file.
struct File {
    std::uint64_t n = 0, entries = 0;
    std::vector<int> start, row;
    std::vector<double> value;

    explicit File(const char *path) : in(path, std::ios::binary) {
        in.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
        read(&n, 1);
        read(&entries, 1);
        take(start, n + 1);
        take(row, entries);
        take(value, entries);
    }
    Lower matrix() const {
        return {Eigen::Index(n), Eigen::Index(n), Eigen::Index(entries),
                start.data(),    row.data(),      value.data()};
    }

private:
    std::ifstream in;
    template <class T> void read(T *to, std::size_t count) {
        in.read(reinterpret_cast<char *>(to), count * sizeof(T));
    }
    template <class T> void take(std::vector<T> &to, std::size_t count) {
        to.resize(count), read(to.data(), count);
    }
};

// Wall and processor seconds of some work.
struct Time {
    double wall = 0, processor = 0;
};
template <class Work> Time timed(Work work) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t used = std::clock();
    work();
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
            double(std::clock() - used) / CLOCKS_PER_SEC};
}

// Longer than this, touching memory for the first time is no part of a factorisation.
const double LONG = 5;

// The second factorisation and solve count: as in all steps of Newton but the first, their memory is there
// already. `factor_entries` checks the analysis and gives the numbers in the factor.
template <class Solver, class Entries> void measure(Solver &solver, const Matrix &a, Entries factor_entries) {
    const Vector b = Vector::NullaryExpr(a.rows(), [](Eigen::Index i) { return i % 2 ? -1.0 : 1.0; });
    Vector x;
    const Time analyse = timed([&] { solver.analyzePattern(a); });
    const double entries = factor_entries();
    Time factor, solve;
    for (int pass = 0; pass < 2 && factor.wall < LONG; ++pass) {
        factor = timed([&] { solver.factorize(a); });
        if (solver.info() != Eigen::Success) throw std::runtime_error("the matrix is not positive definite");
        solve = timed([&] { x = solver.solve(b); });
    }
    const Vector residual = a.selfadjointView<Eigen::Lower>() * x - b;
    std::printf("%.6f\t%.6f\t%.6f\t%.0f\t%.2f\t%.3e\n", analyse.wall, factor.wall, solve.wall, entries,
                factor.processor / factor.wall, residual.lpNorm<Eigen::Infinity>());
}

// Tells what the factor stores, zeros inside supernodes included.
struct Supernodal : Eigen::CholmodSupernodalLLT<Matrix, Eigen::Lower> {
    double stored() const { return double(m_cholmodFactor->xsize); }
};

void cholmod(int ordering, const Matrix &a) {
    Supernodal solver;
    cholmod_common &common = solver.cholmod();
    common.nmethods = 1;
    common.method[0].ordering = ordering;
    measure(solver, a, [&] {
        if (common.status < CHOLMOD_OK)
            throw std::runtime_error("this CHOLMOD cannot analyse with that ordering");
        return solver.stored();
    });
}

void simplicial(const Matrix &a) {
    Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>> solver;
    // The unit diagonal of L is not stored, D is.
    measure(solver, a, [&] { return double(solver.matrixL().nestedExpression().nonZeros() + a.rows()); });
}

// The BLAS under CHOLMOD, as it describes itself or by the file it is in, and its threads if it tells.
std::string blas() {
    using Config = char *();
    using Threads = int();
    if (auto config = reinterpret_cast<Config *>(dlsym(RTLD_DEFAULT, "openblas_get_config"))) {
        auto threads = reinterpret_cast<Threads *>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
        return std::string(config()) + ", " + (threads ? std::to_string(threads()) : "?") + " threads";
    }
    Dl_info info;
    void *product = dlsym(RTLD_DEFAULT, "dgemm_");
    if (!product || !dladdr(product, &info)) return "unknown";
    char *real = realpath(info.dli_fname, nullptr);
    const std::string path = real ? real : info.dli_fname;
    std::free(real);
    return path;
}

int main(int argc, char **argv) try {
    if (argc == 1) {
        std::printf("CHOLMOD %d.%d.%d (BLAS: %s), Eigen %d.%d.%d\n", CHOLMOD_MAIN_VERSION,
                    CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION, blas().c_str(), EIGEN_WORLD_VERSION,
                    EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
        return 0;
    }
    const std::string solver = argc == 3 ? argv[2] : "";
    const bool amd = solver == "CHOLMOD AMD", metis = solver == "CHOLMOD METIS";
    if (!amd && !metis && solver != "Eigen LDLT")
        return std::fprintf(stderr, "usage: peers [MATRIX SOLVER]\n"), 2;
    const Matrix a = File(argv[1]).matrix();
    // The threads that a BLAS starts when it is loaded spin before they sleep.
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    amd || metis ? cholmod(amd ? CHOLMOD_AMD : CHOLMOD_METIS, a) : simplicial(a);
    return 0;
} catch (const std::ios_base::failure &) {
    return std::fprintf(stderr, "peers: %s is not a whole matrix file\n", argv[1]), 1;
} catch (const std::exception &error) {
    return std::fprintf(stderr, "peers: %s\n", error.what()), 1;
}
