// FLIP in bands of rows: what is filtered takes memory by a picture's width, not by its area.
// SPDX-License-Identifier: MIT
#include "lab/flip.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "io/image_formats.hpp"
#include "lab/metrics.hpp"

namespace clgi::lab {
namespace {

// ---- filters: Andersson et al. 2020, spatial filtering and feature detection --------------------

using std::numbers::pi;

// a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees; the paper's constants.
struct Gaussian {
    double a = 0.0;
    double b = 0.0;
};
constexpr Gaussian achromatic{1.0, 0.0047};
constexpr Gaussian red_green{1.0, 0.0053};
constexpr Gaussian blue_yellow[2] = {{34.1, 0.04}, {13.5, 0.025}};
constexpr double feature_width = 0.082;  // degrees, w

// The weights before they are made to sum to 1.
Kernel bell(int radius, double sharpness) {
    Kernel kernel{radius, {}};
    for (int x = -radius; x <= radius; ++x) kernel.weights.push_back(std::exp(-sharpness * x * x));
    return kernel;
}

// Returns the sum that was there.
double normalize(Kernel& kernel) {
    double sum = 0.0;
    for (const double weight : kernel.weights) sum += weight;
    for (double& weight : kernel.weights) weight /= sum;
    return sum;
}

// Positive weights sum to 1, negative ones to -1: flat pictures have no features, and the largest
// possible edge has size 1.
void normalize_signs(Kernel& kernel) {
    double positive = 0.0, negative = 0.0;
    for (const double weight : kernel.weights) (weight > 0.0 ? positive : negative) += weight;
    for (double& weight : kernel.weights) weight /= weight > 0.0 ? positive : -negative;
}

}  // namespace

FlipFilters flip_filters(double pixels_per_degree) {
    FlipFilters filters;
    // Three standard deviations of the widest Gaussian.
    const int radius = static_cast<int>(
        std::ceil(3.0 * std::sqrt(blue_yellow[0].b / (2.0 * pi * pi)) * pixels_per_degree));
    const auto sharpness = [&](const Gaussian& g) {
        return pi * pi / (g.b * pixels_per_degree * pixels_per_degree);
    };
    filters.achromatic = bell(radius, sharpness(achromatic));
    filters.red_green = bell(radius, sharpness(red_green));
    normalize(filters.achromatic);
    normalize(filters.red_green);
    double total = 0.0;
    for (int i = 0; i < 2; ++i) {
        const Gaussian& g = blue_yellow[i];
        filters.blue_yellow[i] = bell(radius, sharpness(g));
        const double sum = normalize(filters.blue_yellow[i]);
        filters.blue_yellow_share[i] = g.a * std::sqrt(pi / g.b) * sum * sum;
        total += filters.blue_yellow_share[i];
    }
    for (double& share : filters.blue_yellow_share) share /= total;

    const double deviation = 0.5 * feature_width * pixels_per_degree;
    const int reach = static_cast<int>(std::ceil(3.0 * deviation));
    filters.smooth = bell(reach, 0.5 / (deviation * deviation));
    filters.edge = filters.point = filters.smooth;
    for (int x = -reach; x <= reach; ++x) {
        const int i = x + reach;
        filters.edge.weights[static_cast<std::size_t>(i)] *= -x;
        filters.point.weights[static_cast<std::size_t>(i)] *= x * x / (deviation * deviation) - 1.0;
    }
    normalize(filters.smooth);
    normalize_signs(filters.edge);
    normalize_signs(filters.point);
    filters.radius = std::max(radius, reach);
    return filters;
}

void filter(const Kernel& kernel, const double* in, int stride, double* out, int count) {
    std::fill(out, out + count, 0.0);
    for (int k = -kernel.radius; k <= kernel.radius; ++k) {
        const int i = kernel.radius + k;
        const double weight = kernel.weights[static_cast<std::size_t>(i)];
        const double* shifted = in + static_cast<std::ptrdiff_t>(k) * stride;
        for (int x = 0; x < count; ++x) out[x] += weight * shifted[x];
    }
}

namespace {

// ---- colours ------------------------------------------------------------------------------------

// X/Xn, Y/Yn and Z/Zn of linear sRGB: white is (1, 1, 1). The primaries' chromaticities of
// IEC 61966-2-1 as exact fractions, every row over its own sum.
const glm::dmat3 relative_xyz_from_rgb =
    glm::transpose(glm::dmat3(glm::dvec3(10135552.0, 8788810.0, 4435075.0) / 23359437.0,
                              glm::dvec3(2613072.0, 8788810.0, 887015.0) / 12288897.0,
                              glm::dvec3(1425312.0, 8788810.0, 70074185.0) / 80288307.0));
const glm::dmat3 rgb_from_relative_xyz = glm::inverse(relative_xyz_from_rgb);

// CIE 15: L* 0 to 100, a* and b*.
glm::dvec3 lab(const glm::dvec3& relative_xyz) {
    constexpr double delta = 6.0 / 29.0;
    const auto f = [](double t) {
        return t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
    };
    const double x = f(relative_xyz.x), y = f(relative_xyz.y), z = f(relative_xyz.z);
    return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

constexpr int band_rows = 64;
constexpr double color_exponent = 0.7;    // q_c
constexpr double knee = 0.4;              // p_c, in parts of the largest colour difference
constexpr double knee_value = 0.95;       // p_t
constexpr double feature_exponent = 0.5;  // q_f

// L* and a*, b* after Hunt: colours look paler where it is darker.
glm::dvec3 hunt_lab(const glm::dvec3& relative_xyz) {
    const glm::dvec3 color = lab(relative_xyz);
    return {color.x, 0.01 * color.x * color.y, 0.01 * color.x * color.z};
}

// City block for lightness, Euclid for colour.
double hyab(const glm::dvec3& a, const glm::dvec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// The distance of green and blue, the largest of any two colours of a screen, is 1.
double compressed(double distance) {
    static const double largest =
        std::pow(hyab(hunt_lab(relative_xyz_from_rgb * glm::dvec3(0.0, 1.0, 0.0)),
                      hunt_lab(relative_xyz_from_rgb * glm::dvec3(0.0, 0.0, 1.0))),
                 color_exponent);
    const double share = std::pow(distance, color_exponent) / largest;
    if (share < knee) return share * knee_value / knee;
    return knee_value + (share - knee) / (1.0 - knee) * (1.0 - knee_value);
}

// YyCxCz, the linear opponent space in which the eye's resolution is known.
glm::dvec3 opponent(const glm::dvec3& rgb) {
    const glm::dvec3 xyz = relative_xyz_from_rgb * rgb;
    return {116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)};
}

glm::dvec3 rgb_of(const glm::dvec3& opponent) {
    const double y = (opponent.x + 16.0) / 116.0;
    return rgb_from_relative_xyz * glm::dvec3(y + opponent.y / 500.0, y, y - opponent.z / 200.0);
}

// One picture's rows first - radius to last + radius, filtered along x.
class Band {
public:
    Band(const Display& picture, const FlipFilters& filters, int first, int last)
        : filters_(filters), width_(picture.width) {
        const int radius = filters.radius, rows = last - first + 2 * radius;
        const auto samples = static_cast<std::size_t>(rows) * static_cast<std::size_t>(width_);
        for (std::vector<double>& plane : planes_) plane.resize(samples);
        const int padded = width_ + 2 * radius;
        std::vector<double> y(static_cast<std::size_t>(padded)), cx(y), cz(y);
        for (int row = 0; row < rows; ++row) {
            const int source = std::clamp(first - radius + row, 0, picture.height - 1);
            for (int x = 0; x < padded; ++x) {
                const auto i = static_cast<std::size_t>(source) * static_cast<std::size_t>(width_) +
                               static_cast<std::size_t>(std::clamp(x - radius, 0, width_ - 1));
                const glm::dvec3 color =
                    opponent({picture.rgb[0][i], picture.rgb[1][i], picture.rgb[2][i]});
                const auto at = static_cast<std::size_t>(x);
                y[at] = color.x, cx[at] = color.y, cz[at] = color.z;
            }
            const auto along = [&](const Kernel& kernel, const std::vector<double>& in, Plane out) {
                filter(kernel, in.data() + radius, 1, row_of(out, row), width_);
            };
            along(filters.achromatic, y, lightness);
            along(filters.red_green, cx, red_green);
            along(filters.blue_yellow[0], cz, blue_yellow_0);
            along(filters.blue_yellow[1], cz, blue_yellow_1);
            along(filters.smooth, y, smooth);
            along(filters.edge, y, edge);
            along(filters.point, y, point);
        }
    }

    // Filters row (0: first) along y too. Afterwards color and features hold that row.
    void finish(int row) {
        const auto down = [&](const Kernel& kernel, Plane in) {
            std::vector<double> out(static_cast<std::size_t>(width_));
            filter(kernel, row_of(in, row + filters_.radius), width_, out.data(), width_);
            return out;
        };
        y_ = down(filters_.achromatic, lightness);
        cx_ = down(filters_.red_green, red_green);
        cz_[0] = down(filters_.blue_yellow[0], blue_yellow_0);
        cz_[1] = down(filters_.blue_yellow[1], blue_yellow_1);
        edge_x_ = down(filters_.smooth, edge);
        edge_y_ = down(filters_.edge, smooth);
        point_x_ = down(filters_.smooth, point);
        point_y_ = down(filters_.point, smooth);
    }

    // What the eye resolves of the finished row, as a colour that a screen can show.
    glm::dvec3 color(std::size_t x) const {
        const double cz =
            filters_.blue_yellow_share[0] * cz_[0][x] + filters_.blue_yellow_share[1] * cz_[1][x];
        const glm::dvec3 rgb = glm::clamp(rgb_of({y_[x], cx_[x], cz}), 0.0, 1.0);
        return hunt_lab(relative_xyz_from_rgb * rgb);
    }
    // The slope and the curvature of lightness, of which black to white is 116.
    double edge_at(std::size_t x) const { return std::hypot(edge_x_[x], edge_y_[x]) / 116.0; }
    double point_at(std::size_t x) const { return std::hypot(point_x_[x], point_y_[x]) / 116.0; }

private:
    enum Plane { lightness, red_green, blue_yellow_0, blue_yellow_1, smooth, edge, point, planes };

    double* row_of(Plane plane, int row) {
        return planes_[plane].data() +
               static_cast<std::size_t>(row) * static_cast<std::size_t>(width_);
    }

    const FlipFilters& filters_;
    int width_;
    std::array<std::vector<double>, planes> planes_;
    std::vector<double> y_, cx_, cz_[2], edge_x_, edge_y_, point_x_, point_y_;
};

double difference(const Band& a, const Band& b, std::size_t x) {
    const double color = compressed(hyab(a.color(x), b.color(x)));
    const double feature =
        std::max(std::abs(a.edge_at(x) - b.edge_at(x)), std::abs(a.point_at(x) - b.point_at(x)));
    // Where an edge or a dot comes or goes, a difference of colour weighs more.
    return std::pow(color, 1.0 - std::pow(feature / std::sqrt(2.0), feature_exponent));
}

}  // namespace

std::vector<float> flip(const Display& a, const Display& b) {
    static const FlipFilters filters = flip_filters();
    std::vector<float> map;
    map.reserve(a.rgb[0].size());
    for (int first = 0; first < a.height; first += band_rows) {
        const int last = std::min(first + band_rows, a.height);
        Band band_a(a, filters, first, last), band_b(b, filters, first, last);
        for (int row = 0; row < last - first; ++row) {
            band_a.finish(row);
            band_b.finish(row);
            for (std::size_t x = 0; x < static_cast<std::size_t>(a.width); ++x) {
                map.push_back(static_cast<float>(difference(band_a, band_b, x)));
            }
        }
    }
    return map;
}

// ---- pictures without an upper limit ------------------------------------------------------------

namespace {

// ACES in Narkowicz's fit, (a x^2 + b x) / (d x^2 + e x + f), x scaled by 0.6 as in the paper.
struct Aces {
    static constexpr double a = 0.6 * 0.6 * 2.51, b = 0.6 * 0.03;
    static constexpr double d = 0.6 * 0.6 * 2.43, e = 0.6 * 0.59, f = 0.14;
};
constexpr double shown_as = 0.85;  // t: what the brightest and the median pixel are tone mapped to

// Steps of a stop would be endless between a sun and a starlit wall.
constexpr int most_exposures = 32;

double tone_mapped(double x) {
    return x * (Aces::a * x + Aces::b) / (x * (Aces::d * x + Aces::e) + Aces::f);
}

// Solves tone_mapped(x) = shown_as.
double shown_radiance() {
    const double p = Aces::a - shown_as * Aces::d, q = Aces::b - shown_as * Aces::e,
                 r = -shown_as * Aces::f;
    return (-q + std::sqrt(q * q - 4.0 * p * r)) / (2.0 * p);
}

double not_negative(float sample) { return std::max(io::finite(sample), 0.0f); }

// Of the pixels that are finite and not black, whose exposure would be infinite.
std::vector<double> lit_luminances(const RgbPlanes& planes) {
    std::vector<double> result;
    for (std::size_t i = 0; i < planes[0]->size(); ++i) {
        const float r = (*planes[0])[i], g = (*planes[1])[i], b = (*planes[2])[i];
        if (!std::isfinite(r) || !std::isfinite(g) || !std::isfinite(b)) continue;
        const double y =
            0.2126 * not_negative(r) + 0.7152 * not_negative(g) + 0.0722 * not_negative(b);
        if (y > 0.0) result.push_back(y);
    }
    return result;
}

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

Exposures exposures(const RgbPlanes& planes) {
    std::vector<double> values = lit_luminances(planes);
    if (values.empty()) return {};
    const double brightest = *std::max_element(values.begin(), values.end());
    const double middle = median(values), shown = shown_radiance();
    const double stops = std::log2(brightest / middle);
    Exposures range{shown / brightest, shown / middle, 1};
    if (stops > 0.0) {
        range.count = std::clamp(static_cast<int>(std::ceil(stops)), 2, most_exposures);
    }
    return range;
}

Display displayed(const RgbPlanes& planes, int width, int height, double exposure) {
    Display display{width, height, {}};
    for (std::size_t c = 0; c < 3; ++c) {
        display.rgb[c].reserve(planes[c]->size());
        for (const float sample : *planes[c]) {
            const double shown = tone_mapped(exposure * not_negative(sample));
            display.rgb[c].push_back(static_cast<float>(std::min(shown, 1.0)));
        }
    }
    return display;
}

}  // namespace

double Exposures::at(int i) const {
    if (count < 2) return first;
    return first * std::pow(last / first, static_cast<double>(i) / (count - 1));
}

Exposures exposures(const io::Image& picture) {
    return exposures(rgb_planes(picture, picture).first);
}

std::vector<float> hdr_flip(const io::Image& test, const io::Image& reference) {
    const auto [tested, truth] = rgb_planes(test, reference);
    std::vector<float> map(truth[0]->size(), 0.0f);
    Exposures range = exposures(truth);
    // A black picture has no exposure of its own: light in the other one must not go unseen.
    if (range.count == 0) range = exposures(tested);
    for (int i = 0; i < range.count; ++i) {
        const double exposure = range.at(i);
        const std::vector<float> errors = flip(displayed(tested, test.width, test.height, exposure),
                                               displayed(truth, test.width, test.height, exposure));
        std::transform(map.begin(), map.end(), errors.begin(), map.begin(),
                       [](float so_far, float here) { return std::max(so_far, here); });
    }
    return map;
}

}  // namespace clgi::lab
