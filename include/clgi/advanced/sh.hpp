// Real spherical harmonics: basis, rotation, windows, functions around an axis.
//
// The basis is orthonormal over the sphere (steradians) and has no Condon-Shortley sign. Term
// l^2 + l + m belongs to degree l and order m, -l <= m <= l; "bands" are degrees 0 to bands - 1.
// Terms 1, 2, 3 are sqrt(3 / 4 pi) times y, z, x: the polar axis is z, whichever way is up.
// A function f has the coefficients c_i = integral f Y_i, in its own unit times steradians, and
// f = sum c_i Y_i. [Ramamoorthi01] has the same sign; others negate odd orders.
//
// A kernel is a function k(cos gamma) around an axis, given by one number a band,
//   k_l = 2 pi integral_-1^1 k(z) P_l(z) dz.
// Around the direction s it has the coefficients k_l Y_i(s), and it convolves f to k_l c_i.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/error.hpp>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace clgi::sh {

constexpr int most_bands = 9;     // of every function here; more throw Error
constexpr int default_bands = 5;  // 25 terms [Kautz04, section 3]

constexpr int terms(int bands) { return bands * bands; }
constexpr int index(int l, int m) { return l * l + l + m; }

// The degree of a term.
constexpr int degree(int term) {
    int l = 0;
    while ((l + 1) * (l + 1) <= term) ++l;
    return l;
}

// ---- the basis ---------------------------------------------------------------------------------

// Y_i of a unit direction. Orders other than 0 are exactly 0 at both poles.
CLGI_API void evaluate(const glm::dvec3& direction, int bands, double* out);  // [terms(bands)]
CLGI_API void evaluate(const glm::vec3& direction, int bands, float* out);
CLGI_API std::vector<double> evaluate(const glm::dvec3& direction, int bands);

// sum c_i Y_i(direction); as many bands as there are coefficients for.
CLGI_API double value(const std::vector<double>& coefficients, const glm::dvec3& direction);

// The bands of so many coefficients. Throws Error unless it is a square from 1 to 81.
CLGI_API int bands_of(std::size_t coefficients);

// ---- rotation ----------------------------------------------------------------------------------

// Coefficients of f(R^-1 s) from those of f(s): what f shows at s moves to R s. One block of
// (2 l + 1)^2 numbers a band [Ivanic96, with its corrections].
class CLGI_API Rotation {
public:
    // R is orthogonal; a reflection is one too. Throws Error where it is not.
    Rotation(const glm::dmat3& matrix, int bands);

    int bands() const { return bands_; }
    // What the term of order `from` of degree l adds to that of order `to`.
    double entry(int l, int to, int from) const;
    // Band after band, [to][from]: 1 + 9 + 25 + ... numbers, for the device.
    const std::vector<double>& blocks() const { return blocks_; }

    // Of double, float, dvec3 or vec3. Fewer bands than the rotation has are rotated alone.
    template <typename T>
    std::vector<T> operator()(const std::vector<T>& coefficients) const;

private:
    int bands_;
    std::vector<double> blocks_;
};

// Where the block of a band begins in Rotation::blocks(); of all bands, their number.
constexpr int rotation_block(int l) { return l * (4 * l * l - 1) / 3; }

// ---- kernels around an axis ----------------------------------------------------------------

// max(0, cos): irradiance of radiance [Ramamoorthi01]. pi, 2 pi / 3, pi / 4, 0, -pi / 24 ...
CLGI_API std::vector<double> cosine_kernel(int bands);
// max(0, cos)^exponent, at least 0; exponent 0 is 1 in front and 0 behind.
CLGI_API std::vector<double> power_kernel(double exponent, int bands);
// (n + 2) / (2 pi) max(0, cos)^n: the lobe of docs/materials.md, which multiplies irradiance.
CLGI_API std::vector<double> phong_kernel(double exponent, int bands);
// 1 within an angle of the axis, radians in [0, pi], and 0 beyond it.
CLGI_API std::vector<double> cap_kernel(double half_angle, int bands);

// Coefficients of a kernel around a unit direction. Of {1, 1, 1, ...}: of a light from there alone,
// such as a directional light of 1 lux at perpendicular incidence.
CLGI_API std::vector<double> around(const glm::dvec3& direction, const std::vector<double>& kernel);

// k_l c_i, of double, float, dvec3 or vec3: a convolution, or a window.
template <typename T>
std::vector<T> convolve(const std::vector<double>& kernel, std::vector<T> coefficients);

// ---- windows ---------------------------------------------------------------------------------

// A window lessens high bands, and with them the ringing around bright spots: one factor a band.
// None of them makes every function non-negative.
enum class Window {
    none,
    hann,    // (1 + cos(pi l / bands)) / 2
    lanczos  // sin(pi l / bands) / (pi l / bands)
};
CLGI_API std::vector<double> window(Window kind, int bands);

// 1 / (1 + smoothing l^2 (l + 1)^2): the least curved function near f [Sloan08].
CLGI_API std::vector<double> smoothing_window(double smoothing, int bands);

// A smoothing at which the least value of f over all directions is `lowest` or more; 0 where f
// itself is. It is the smallest, to three digits, if the least value rises with smoothing, as it
// mostly does; else a smaller one may suffice as well. Throws Error if no smoothing suffices: f's
// mean is at most `lowest`. Directions are those of a grid that is eight times finer than the last
// band.
CLGI_API double least_smoothing(const std::vector<double>& coefficients, double lowest);

// ---- what light does ----------------------------------------------------------------------------

// Irradiance of a surface with this normal under radiance of these coefficients, without shadows:
// lux of cd/m^2. It may be negative where the light rings.
CLGI_API glm::dvec3 irradiance(const std::vector<glm::dvec3>& radiance, const glm::dvec3& normal);

// ---- templates ---------------------------------------------------------------------------------

template <typename T>
std::vector<T> Rotation::operator()(const std::vector<T>& coefficients) const {
    const int count = bands_of(coefficients.size());
    if (count > bands_)
        throw Error("sh: a rotation of " + std::to_string(bands_) + " bands got coefficients of " +
                    std::to_string(count));
    std::vector<T> out(coefficients.size(), T(0));
    for (int l = 0; l < count; ++l)
        for (int to = -l; to <= l; ++to) {
            T sum(0);
            for (int from = -l; from <= l; ++from)
                sum +=
                    coefficients[static_cast<std::size_t>(index(l, from))] * T(entry(l, to, from));
            out[static_cast<std::size_t>(index(l, to))] = sum;
        }
    return out;
}

template <typename T>
std::vector<T> convolve(const std::vector<double>& kernel, std::vector<T> coefficients) {
    const int count = bands_of(coefficients.size());
    if (static_cast<std::size_t>(count) > kernel.size())
        throw Error("sh: a kernel of " + std::to_string(kernel.size()) +
                    " bands got coefficients of " + std::to_string(count));
    for (std::size_t i = 0; i < coefficients.size(); ++i)
        coefficients[i] *= T(kernel[static_cast<std::size_t>(degree(static_cast<int>(i)))]);
    return coefficients;
}

}  // namespace clgi::sh
