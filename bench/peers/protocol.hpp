// How a peer talks to the bench.
//
// Called as `PROGRAM INPUT CENTER`. INPUT is two little-endian 64-bit counts, rows and columns, then the rows as
// little-endian doubles. When the rows are in memory the program prints `{"ready":true}`; after that it solves
// once for each line it reads and answers with one line of JSON. Seconds are those of the solver alone: neither
// reading the file nor building the peer's own point type is counted. The center is written to CENTER as doubles.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

struct Input {
    std::size_t rows = 0, columns = 0;
    std::vector<double> values;

    const double *row(std::size_t i) const { return values.data() + i * columns; }
};

struct Found {
    double radius = 0;
    std::vector<double> center;
    std::size_t support = 0;
};

inline Input read_input(const char *path) {
    std::FILE *file = std::fopen(path, "rb");
    std::uint64_t head[2];
    Input input;
    if (!file || std::fread(head, sizeof(std::uint64_t), 2, file) != 2) {
        std::fprintf(stderr, "%s: no header of rows and columns\n", path);
        std::exit(2);
    }
    input.rows = head[0];
    input.columns = head[1];
    input.values.resize(input.rows * input.columns);
    if (std::fread(input.values.data(), sizeof(double), input.values.size(), file) != input.values.size()) {
        std::fprintf(stderr, "%s: shorter than its header says\n", path);
        std::exit(2);
    }
    std::fclose(file);
    return input;
}

class Stopwatch {
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();

  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
};

// Calls `solve(seconds)` for each line of standard input; it returns what was found and sets the seconds taken.
template <typename Solve> int serve(const char *center_path, Solve solve) {
    std::puts("{\"ready\":true}");
    std::fflush(stdout);
    char line[64];
    while (std::fgets(line, sizeof line, stdin)) {
        double seconds = 0;
        const Found found = solve(seconds);
        std::FILE *file = std::fopen(center_path, "wb");
        if (!file || std::fwrite(found.center.data(), sizeof(double), found.center.size(), file) != found.center.size()) {
            std::fprintf(stderr, "%s: the center could not be written\n", center_path);
            return 2;
        }
        std::fclose(file);
        std::printf("{\"seconds\":%.9g,\"radius\":%.17g,\"support\":%zu}\n", seconds, found.radius, found.support);
        std::fflush(stdout);
    }
    return 0;
}
