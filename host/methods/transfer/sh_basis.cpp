// The basis by recurrences that are normalised from the start: no factorial, no overflow.
//
//   Y_lm = Q_lm(z) Re (x + i y)^m,  Y_l-m = Q_lm(z) Im (x + i y)^m,  m > 0
//   Q_mm = Q_m-1,m-1 sqrt((2 m + 1) / (2 m)),  times sqrt(2) once at m = 1
//   Q_lm = a_lm z Q_l-1,m - b_lm Q_l-2,m
//   a_lm = sqrt((4 l^2 - 1) / (l^2 - m^2)),
//   b_lm = a_lm sqrt(((l - 1)^2 - m^2) / (4 (l - 1)^2 - 1))
//                 [derived: recurrences of the associated Legendre functions, Press07, section 6.7]
// SPDX-License-Identifier: MIT
#include <array>
#include <clgi/advanced/sh.hpp>
#include <cmath>
#include <numbers>

#include "methods/transfer/sh_check.hpp"

namespace clgi::sh {
namespace {

// Of each l and m at index(l, m), m >= 0; m = l: what Q_mm is.
struct Recurrence {
    std::array<double, most_bands * most_bands> a{}, b{};
    Recurrence() {
        double sectoral = 0.5 / std::sqrt(std::numbers::pi);
        for (int m = 0; m < most_bands; ++m) {
            if (m > 0) sectoral *= std::sqrt((2.0 * m + 1.0) / (m == 1 ? 1.0 : 2.0 * m));
            a[at(m, m)] = sectoral;
            for (int l = m + 1; l < most_bands; ++l) {
                const double ll = l * l, mm = m * m, before = (l - 1.0) * (l - 1.0);
                a[at(l, m)] = std::sqrt((4.0 * ll - 1.0) / (ll - mm));
                b[at(l, m)] = a[at(l, m)] * std::sqrt((before - mm) / (4.0 * before - 1.0));
            }
            b[at(m, m)] = 0.0;
        }
    }
    static std::size_t at(int l, int m) { return static_cast<std::size_t>(index(l, m)); }
};

template <typename Vector, typename T>
void evaluate_terms(const Vector& s, int bands, T* out) {
    need_bands(bands);
    static const Recurrence recurrence;
    T cosine(1), sine(0);  // of m times the azimuth, times the ring's radius to the m-th
    for (int m = 0; m < bands; ++m) {
        T before(0), q(recurrence.a[Recurrence::at(m, m)]);
        for (int l = m; l < bands; ++l) {
            if (l > m) {
                const T next = T(recurrence.a[Recurrence::at(l, m)]) * s.z * q -
                               T(recurrence.b[Recurrence::at(l, m)]) * before;
                before = q;
                q = next;
            }
            out[index(l, m)] = q * cosine;
            if (m > 0) out[index(l, -m)] = q * sine;
        }
        const T turned = s.x * cosine - s.y * sine;
        sine = s.x * sine + s.y * cosine;
        cosine = turned;
    }
}

}  // namespace

void evaluate(const glm::dvec3& direction, int bands, double* out) {
    evaluate_terms(direction, bands, out);
}

void evaluate(const glm::vec3& direction, int bands, float* out) {
    evaluate_terms(direction, bands, out);
}

std::vector<double> evaluate(const glm::dvec3& direction, int bands) {
    need_bands(bands);
    std::vector<double> out(static_cast<std::size_t>(terms(bands)));
    evaluate(direction, bands, out.data());
    return out;
}

double value(const std::vector<double>& coefficients, const glm::dvec3& direction) {
    std::array<double, terms(most_bands)> basis;
    evaluate(direction, bands_of(coefficients.size()), basis.data());
    double sum = 0.0;
    for (std::size_t i = 0; i < coefficients.size(); ++i) sum += coefficients[i] * basis[i];
    return sum;
}

int bands_of(std::size_t coefficients) {
    for (int bands = 1; bands <= most_bands; ++bands)
        if (static_cast<std::size_t>(terms(bands)) == coefficients) return bands;
    throw Error("sh: " + std::to_string(coefficients) +
                " coefficients, a square from 1 to 81 needed");
}

glm::dvec3 irradiance(const std::vector<glm::dvec3>& radiance, const glm::dvec3& normal) {
    const int bands = bands_of(radiance.size());
    const std::vector<double> toward = around(normal, cosine_kernel(bands));
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < radiance.size(); ++i) sum += radiance[i] * toward[i];
    return sum;
}

}  // namespace clgi::sh
