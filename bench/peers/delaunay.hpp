// How a peer of `bench delaunay` talks to the bench.
//
// Called with the name of a file at the end: raw little-endian doubles, the coordinates of one point after another.
// It reads the points into the type it works on, then builds one triangulation and prints one line of JSON:
//
//   program    name and version
//   points     how many were read
//   simplices  finite triangles or tetrahedra
//   cpu, wall  seconds of the build alone; cpu is user and system time of all threads of the process
//   peak       bytes resident at the peak of the build above those before it, its result included
//
// The mark of the largest resident size is set back by writing 5 to /proc/self/clear_refs, so that the points that
// were read are not counted. One build per process: every program pays for its memory as its users do.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <vector>

template <int Dim, typename Point, typename Make> std::vector<Point> read_points(const char *path, Make make) {
    std::FILE *file = std::fopen(path, "rb");
    if (!file) {
        std::perror(path);
        std::exit(2);
    }
    std::fseek(file, 0, SEEK_END);
    const std::size_t count = std::ftell(file) / (Dim * sizeof(double));
    std::rewind(file);
    std::vector<Point> points;
    points.reserve(count);
    double row[Dim];
    for (std::size_t i = 0; i < count; ++i) {
        if (std::fread(row, sizeof(double), Dim, file) != Dim) {
            std::perror(path);
            std::exit(2);
        }
        points.push_back(make(row));
    }
    std::fclose(file);
    return points;
}

class Meter {
    static double cpu() {
        timespec time;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return time.tv_sec + 1e-9 * time.tv_nsec;
    }

    // A size out of /proc/self/status, in bytes; negative where it does not tell.
    static long long status(const char *field) {
        std::FILE *file = std::fopen("/proc/self/status", "r");
        char line[256];
        long long size = -1;
        while (file && std::fgets(line, sizeof line, file)) {
            if (std::strncmp(line, field, std::strlen(field)) == 0) size = std::atoll(line + std::strlen(field)) << 10;
        }
        if (file) std::fclose(file);
        return size;
    }

    static bool reset() {
        std::FILE *file = std::fopen("/proc/self/clear_refs", "w");
        return file && std::fputs("5", file) >= 0 && std::fclose(file) == 0;
    }

    long long held = reset() ? status("VmRSS:") : -1;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    double before = cpu();

  public:
    // To be called before the result is destroyed.
    void print(const char *program, std::size_t points, std::size_t simplices) const {
        const double spent = cpu() - before;
        const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        const long long mark = status("VmHWM:");
        std::printf("{\"program\":\"%s\",\"points\":%zu,\"simplices\":%zu,\"cpu\":%.9g,\"wall\":%.9g,\"peak\":", program,
                    points, simplices, spent, wall);
        if (held < 0 || mark < 0) std::puts("null}");
        else std::printf("%lld}\n", mark > held ? mark - held : 0);
    }
};
