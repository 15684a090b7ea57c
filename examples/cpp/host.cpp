// A host with its own arrays, memory, threads and progress bar: splines near a sphere and a torus, fitted on
// two of its threads, and the nearest points to many points in random order and in an order along the
// surface.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <future>
#include <memory>
#include <random>
#include <ricci/ricci.hpp>
#include <thread>

namespace {

// The host's memory, of which it keeps account.
std::atomic<std::size_t> in_use{0};

template <class T> struct counted {
    using value_type = T;
    counted() = default;
    template <class U> counted(const counted<U> &) {}
    T *allocate(std::size_t n) {
        in_use += n * sizeof(T);
        return static_cast<T *>(::operator new(n * sizeof(T)));
    }
    void deallocate(T *place, std::size_t n) {
        in_use -= n * sizeof(T);
        ::operator delete(place);
    }
};
template <class T, class U> bool operator==(const counted<T> &, const counted<U> &) { return true; }
template <class T, class U> bool operator!=(const counted<T> &, const counted<U> &) { return false; }

// Points numbered from 1, as CAD kernels have them, x, y, z one after the other in memory.
struct points {
    explicit points(std::size_t n) : xyz(3 * n) {}
    std::size_t upper() const { return xyz.size() / 3; }
    double *value(std::size_t i) { return &xyz[3 * (i - 1)]; }
    ricci::span<double> all() const { return xyz; }
    std::vector<double, counted<double>> xyz;
};

// The host's progress bar, on a thread of its own, until the call has returned.
struct progress_bar {
    progress_bar(const char *name, const ricci::control &watched)
        : thread_([this, name, &watched] {
              while (!done_) {
                  std::fprintf(stderr, "\r%s %3.0f %%", name, 100 * watched.progress().second);
                  std::this_thread::sleep_for(std::chrono::milliseconds(50));
              }
              std::fprintf(stderr, "\r%s done \n", name);
          }) {}
    ~progress_bar() {
        done_ = true;
        thread_.join();
    }
    std::atomic<bool> done_{false};
    std::thread thread_;
};

ricci::spline fitted(std::uint32_t shape, std::size_t n, std::size_t m, const ricci::control &watched) {
    ricci_shape what = ricci::init<ricci_shape>();
    what.shape = shape, what.n = n, what.m = m, what.a = 2, what.b = 0.8;
    ricci_spline_surface_options options = ricci::init<ricci_spline_surface_options>();
    options.threads = 1; // the host has threads of its own
    return ricci::spline::of_mesh(ricci::mesh::made(what), options, &watched);
}

// Points per second, at best, and the distances.
double speed(const ricci::spline &surface, const points &at, std::vector<double> &distances) {
    double best = 0;
    for (int round = 0; round < 3; round++) {
        const auto start = std::chrono::steady_clock::now();
        const auto found = surface.closest(at.all());
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        best = std::max(best, double(at.upper()) / time.count());
        for (std::size_t k = 0; k < at.upper(); k++) distances[k] = found.values[6 * k + 5];
    }
    return best;
}

} // namespace

int main(int argc, char **argv) {
    try {
        const std::size_t n = argc > 1 ? std::stoul(argv[1]) : 40, count = n * n * 10;
        const ricci::control sphere_control, torus_control;
        auto later =
            std::async(std::launch::async, fitted, RICCI_SHAPE_SPHERE, n / 4, 0, std::cref(sphere_control));
        std::unique_ptr<progress_bar> bar(new progress_bar("torus", torus_control));
        const ricci::spline torus = fitted(RICCI_SHAPE_TORUS, n, n / 2, torus_control);
        bar.reset();
        const ricci::spline sphere = later.get();
        for (const auto &s : {torus.summary(), sphere.summary()})
            if (s.converged != 1 || s.n_folded_patches != 0) return 1;
        // Points 0.1 outside the torus, along its tube and in random order.
        points sorted(count), shuffled(count);
        std::vector<std::size_t> order(count);
        for (std::size_t k = 0; k < count; k++) {
            const double u = 6.283185307 * double(k) / double(count), v = 200 * u, r = 2 + 0.9 * std::cos(v);
            double *p = sorted.value(k + 1);
            p[0] = r * std::cos(u), p[1] = r * std::sin(u), p[2] = 0.9 * std::sin(v), order[k] = k;
        }
        std::shuffle(order.begin(), order.end(), std::mt19937(1));
        for (std::size_t k = 0; k < count; k++)
            std::copy_n(sorted.value(order[k] + 1), 3, shuffled.value(k + 1));
        std::vector<double> along(count), anyhow(count);
        const double ratio = 1 / speed(torus, sorted, along) * speed(torus, shuffled, anyhow);
        bool good = ratio >= 0.8 && in_use >= 6 * count * sizeof(double);
        for (std::size_t k = 0; k < count; k++)
            good = good && anyhow[k] == along[order[k]] && std::abs(along[k] - 0.1) < 0.02;
        std::printf("nearest points in random order at %.2f of the speed in order\n", ratio);
        return good ? 0 : 1;
    } catch (const ricci::error &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
