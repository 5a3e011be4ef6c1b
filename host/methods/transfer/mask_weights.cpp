// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <clgi/advanced/mask_weights.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <numbers>
#include <random>

namespace clgi {
namespace {

using std::numbers::pi;

// The first 2 l + 1 of them determine a function of degree l: the condition number of Y_lm(d_j) is
// below 10 for every l. Found by a random search.
constexpr std::array<std::array<double, 3>, 17> turning_directions = {{
    {0.608684069, -0.670640076, 0.423964141},
    {0.343599249, 0.704340598, 0.621163326},
    {-0.591965935, -0.280898038, 0.755428769},
    {0.690596705, -0.628433202, -0.357977516},
    {0.337352463, 0.852076451, -0.400198747},
    {-0.621093459, 0.218784811, 0.752579645},
    {-0.064710534, 0.371061962, -0.926350672},
    {-0.352458084, 0.647569548, 0.675593797},
    {0.619089509, -0.177339254, 0.765035273},
    {0.405706395, -0.877399688, -0.256070514},
    {-0.713638236, -0.644745470, -0.273904633},
    {-0.993993988, -0.109320020, 0.005008441},
    {-0.151568890, -0.985133460, 0.080863694},
    {-0.782585108, 0.619702945, 0.059403778},
    {0.751143886, 0.086362883, -0.654464907},
    {0.045798231, -0.942720568, 0.330424655},
    {0.753345599, -0.385270844, 0.532951015},
}};

// As the kernel has it: unit, in float.
glm::vec3 turning_direction(int j) {
    const auto& d = turning_directions[static_cast<std::size_t>(j)];
    return glm::vec3(glm::normalize(glm::dvec3(d[0], d[1], d[2])));
}

struct Rule {
    std::vector<double> node, weight;  // on [-1, 1]
};

// Gauss-Legendre, by Newton's method.
Rule gauss(int count) {
    Rule out;
    for (int i = 0; i < count; ++i) {
        double x = std::cos(pi * (i + 0.75) / (count + 0.5)), slope = 1.0;
        for (int step = 0; step < 50; ++step) {
            double p = 1.0, before = 0.0;
            for (int n = 1; n <= count; ++n) {
                const double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
                before = p;
                p = next;
            }
            slope = count * (x * p - before) / (x * x - 1.0);
            const double change = p / slope;
            x -= change;
            if (std::abs(change) < 1e-16) break;
        }
        out.node.push_back(x);
        out.weight.push_back(2.0 / ((1.0 - x * x) * slope * slope));
    }
    return out;
}

// Adds weight, direction for every node of a rule over a rectangle in the disc. With x = sin u and
// y = cos u sin v the height cos u cos v has no root at the edge of the disc.
template <typename Add>
void integrate(double x0, double x1, double y0, double y1, const Rule& rule, Add add) {
    // Where the circle crosses a side, limits change.
    std::vector<double> ends = {x0, x1};
    for (const double y : {y0, y1})
        if (std::abs(y) < 1.0)
            for (const double x : {-std::sqrt(1.0 - y * y), std::sqrt(1.0 - y * y)})
                if (x > x0 && x < x1) ends.push_back(x);
    std::sort(ends.begin(), ends.end());
    for (std::size_t part = 0; part + 1 < ends.size(); ++part) {
        const double a = std::asin(std::clamp(ends[part], -1.0, 1.0));
        const double b = std::asin(std::clamp(ends[part + 1], -1.0, 1.0));
        for (std::size_t i = 0; i < rule.node.size(); ++i) {
            const double u = 0.5 * (a + b) + 0.5 * (b - a) * rule.node[i];
            const double x = std::sin(u), ring = std::cos(u);
            if (!(ring > 0.0)) continue;
            const double c = std::asin(std::clamp(y0 / ring, -1.0, 1.0));
            const double d = std::asin(std::clamp(y1 / ring, -1.0, 1.0));
            for (std::size_t k = 0; d > c && k < rule.node.size(); ++k) {
                const double v = 0.5 * (c + d) + 0.5 * (d - c) * rule.node[k];
                const double height = ring * std::cos(v);
                add(0.25 * (b - a) * (d - c) * rule.weight[i] * rule.weight[k] * ring * height,
                    glm::dvec3(x, ring * std::sin(v), height));
            }
        }
    }
}

// Of A^T z = c, for all right sides at once: the inverse, by elimination with row pivots.
std::vector<double> inverse(std::vector<double> a, int n) {
    std::vector<double> out(a.size());
    const auto at = [n](int row, int column) { return static_cast<std::size_t>(row * n + column); };
    for (int i = 0; i < n; ++i) out[at(i, i)] = 1.0;
    for (int k = 0; k < n; ++k) {
        int best = k;
        for (int i = k + 1; i < n; ++i)
            if (std::abs(a[at(i, k)]) > std::abs(a[at(best, k)])) best = i;
        for (int j = 0; j < n; ++j) {
            std::swap(a[at(k, j)], a[at(best, j)]);
            std::swap(out[at(k, j)], out[at(best, j)]);
        }
        const double scale = 1.0 / a[at(k, k)];
        for (int j = 0; j < n; ++j) {
            a[at(k, j)] *= scale;
            out[at(k, j)] *= scale;
        }
        for (int i = 0; i < n; ++i) {
            const double factor = a[at(i, k)];
            if (i == k || factor == 0.0) continue;
            for (int j = 0; j < n; ++j) {
                a[at(i, j)] -= factor * a[at(k, j)];
                out[at(i, j)] -= factor * out[at(k, j)];
            }
        }
    }
    return out;
}

// The matrices that make z of c, one a degree.
std::vector<std::vector<double>> turning_matrices(int bands) {
    std::vector<std::vector<double>> out;
    for (int l = 0; l < bands; ++l) {
        const int n = 2 * l + 1;
        std::vector<double> transposed(static_cast<std::size_t>(n * n));
        for (int j = 0; j < n; ++j) {
            const std::vector<double> y = sh::evaluate(glm::dvec3(turning_direction(j)), bands);
            for (int m = 0; m < n; ++m)
                transposed[static_cast<std::size_t>(m * n + j)] =
                    y[static_cast<std::size_t>(l * l + m)];
        }
        out.push_back(inverse(transposed, n));
    }
    return out;
}

void check(int size, int block, int bands) {
    const auto refuse = [](const char* name, int got, const char* needed) {
        throw Error(std::string("mask_weights: ") + name + " is " + std::to_string(got) + ", " +
                    needed + " needed");
    };
    if (size != 8 && size != 16 && size != 32 && size != 64 && size != 128)
        refuse("size", size, "8, 16, 32, 64 or 128");
    if (block != 1 && block != 2 && block != 4 && block != 8)
        refuse("block", block, "1, 2, 4 or 8");
    if (bands < 1 || bands > sh::most_bands) refuse("bands", bands, "1 to 9");
}

// Of the cells along one side; the disc is divided evenly.
struct Cells {
    int size, block, side;
    double low(int k) const { return 2.0 * k * block / size - 1.0; }
    int at(double x) const {  // the column or row of the pixel there
        return std::clamp(static_cast<int>(0.5 * (x + 1.0) * size), 0, size - 1) / block;
    }
    double middle(int k) const { return 0.5 * (low(k) + low(k + 1)); }
    double farthest(int k) const {  // squared, from the middle of the disc
        return std::max(low(k) * low(k), low(k + 1) * low(k + 1));
    }
    std::uint32_t pixels(int column, int row) const {
        std::uint32_t out = 0;
        for (int i = column * block; i < (column + 1) * block; ++i)
            for (int j = row * block; j < (row + 1) * block; ++j) {
                const int x = 2 * i + 1 - size, y = 2 * j + 1 - size;
                out += x * x + y * y < size * size;
            }
        return out;
    }
};

// [cells][terms + 3]: the integrals of Y_i over the part of a cell in the disc, and of the
// direction.
std::vector<double> exact_sums(const Cells& grid, int bands) {
    const auto terms = static_cast<std::size_t>(sh::terms(bands));
    std::vector<double> sums;
    // Limits have a root where the circle crosses a side.
    const Rule smooth = gauss(8 * grid.block >= grid.size ? 16 : 8), cut = gauss(32);
    for (int column = 0; column < grid.side; ++column)
        for (int row = 0; row < grid.side; ++row) {
            const std::size_t first = sums.size();
            sums.resize(first + terms + 3);
            const bool whole = grid.farthest(column) + grid.farthest(row) < 1.0;
            integrate(grid.low(column), grid.low(column + 1), grid.low(row), grid.low(row + 1),
                      whole ? smooth : cut, [&](double weight, const glm::dvec3& s) {
                          const std::vector<double> y = sh::evaluate(s, bands);
                          for (std::size_t i = 0; i < terms; ++i) sums[first + i] += weight * y[i];
                          for (int k = 0; k < 3; ++k)
                              sums[first + terms + static_cast<std::size_t>(k)] += weight * s[k];
                      });
        }
    return sums;
}

// Puts the estimate from `count` random directions in the place of the integrals of Y_i.
void monte_carlo(const Cells& grid, int bands, std::uint32_t count, std::vector<double>& sums) {
    const auto terms = static_cast<std::size_t>(sh::terms(bands));
    const std::size_t stride = terms + 3;
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (i % stride < terms) sums[i] = 0.0;
    // Not std::uniform_real_distribution: its numbers differ between standard libraries.
    std::mt19937_64 generator(static_cast<std::uint64_t>(grid.size));
    const auto uniform = [&] { return std::ldexp(static_cast<double>(generator() >> 11), -53); };
    for (std::uint32_t k = 0; k < count; ++k) {
        // Uniform in the disc: the density of the direction is cos / pi.
        const double area = uniform(), turn = 2.0 * pi * uniform();
        const glm::dvec3 s(std::sqrt(area) * std::cos(turn), std::sqrt(area) * std::sin(turn),
                           std::sqrt(1.0 - area));
        const auto cell = static_cast<std::size_t>(grid.at(s.x) * grid.side + grid.at(s.y));
        const std::vector<double> y = sh::evaluate(s, bands);
        for (std::size_t i = 0; i < terms; ++i) sums[cell * stride + i] += y[i] * pi / count;
    }
}

// Cells without a pixel give what they have to the nearest one that has some.
void merge_empty(const Cells& grid, std::size_t stride, const std::vector<std::uint32_t>& pixels,
                 std::vector<double>& integrals) {
    for (int cell = 0; cell < grid.side * grid.side; ++cell) {
        const auto from = static_cast<std::size_t>(cell);
        if (pixels[from] > 0) continue;
        std::size_t nearest = from;
        int least = grid.side * grid.side * 2;
        for (int other = 0; other < grid.side * grid.side; ++other) {
            const int across = other / grid.side - cell / grid.side;
            const int along = other % grid.side - cell % grid.side;
            const int distance = across * across + along * along;
            if (pixels[static_cast<std::size_t>(other)] == 0 || distance >= least) continue;
            least = distance;
            nearest = static_cast<std::size_t>(other);
        }
        for (std::size_t i = 0; i < stride; ++i) {
            integrals[nearest * stride + i] += integrals[from * stride + i];
            integrals[from * stride + i] = 0.0;
        }
    }
}

}  // namespace

MaskWeights mask_weights(int size, int block, int bands, CellIntegral integral) {
    check(size, block, bands);
    const Cells grid{size, block, size / block};
    const auto terms = static_cast<std::size_t>(sh::terms(bands));
    const std::size_t stride = terms + 3;  // and of the direction itself
    const auto cells = static_cast<std::size_t>(grid.side * grid.side);
    MaskWeights out;
    out.cells = grid.side * grid.side;
    out.bands = bands;
    std::uint32_t all = 0;
    for (int column = 0; column < grid.side; ++column)
        for (int row = 0; row < grid.side; ++row) {
            out.pixels.push_back(grid.pixels(column, row));
            all += out.pixels.back();
        }
    std::vector<double> sums = exact_sums(grid, bands);
    if (integral == CellIntegral::monte_carlo) monte_carlo(grid, bands, all, sums);
    merge_empty(grid, stride, out.pixels, sums);
    for (std::size_t cell = 0; cell < cells; ++cell) {
        double* c = &sums[cell * stride];
        if (integral == CellIntegral::centre) {
            const int column = static_cast<int>(cell) / grid.side;
            const int row = static_cast<int>(cell) % grid.side;
            glm::dvec2 p(grid.middle(column), grid.middle(row));
            p *= std::min(1.0, 0.999 / glm::length(p));
            const std::vector<double> y =
                sh::evaluate(glm::dvec3(p, std::sqrt(1.0 - glm::dot(p, p))), bands);
            for (std::size_t i = 0; i < terms; ++i) c[i] = y[i] * pi * out.pixels[cell] / all;
        }
        out.integrals.insert(out.integrals.end(), c, c + terms);
    }

    for (int j = 0; j < 2 * bands - 1; ++j) out.directions.emplace_back(turning_direction(j), 0.0f);
    for (std::size_t cell = 0; cell < cells; ++cell) {
        const double* s = &sums[cell * stride + terms];
        glm::dvec3 mean(s[0], s[1], s[2]);
        mean = out.pixels[cell] > 0 ? glm::normalize(mean) : glm::dvec3(0.0, 0.0, 1.0);
        out.directions.emplace_back(glm::vec3(mean), static_cast<float>(out.pixels[cell]));
    }
    const std::vector<std::vector<double>> turns = turning_matrices(bands);
    std::vector<double> total(terms);
    for (std::size_t cell = 0; cell < cells; ++cell)
        for (int l = 0; l < bands; ++l) {
            const int n = 2 * l + 1;
            for (int j = 0; j < n; ++j) {
                double z = 0.0;
                for (int m = 0; m < n; ++m)
                    z += turns[static_cast<std::size_t>(l)][static_cast<std::size_t>(j * n + m)] *
                         out.integrals[cell * terms + static_cast<std::size_t>(l * l + m)];
                total[static_cast<std::size_t>(l * l + j)] += z;
                out.values.push_back(static_cast<float>(z / std::max(out.pixels[cell], 1u)));
            }
        }
    for (const double z : total) out.values.push_back(static_cast<float>(z));
    return out;
}

}  // namespace clgi
