// Rotation blocks of one band from those of the band before.
//
//   R^l_mn = u U + v V + w W                      [Ivanic96, Eq. 8.1 and tables 1 and 2, with the
//                                                  corrections in J. Phys. Chem. A 102 (1998) 9099]
//
// Names of the letters are the paper's. Their real harmonics have the sign of ours.
// SPDX-License-Identifier: MIT
#include <clgi/advanced/sh.hpp>
#include <cmath>
#include <cstdlib>

#include "methods/transfer/sh_check.hpp"

namespace clgi::sh {
namespace {

// Sums that cancel leave this much. It becomes 0, so that a permutation of the axes gives no light
// to a term that has none.
constexpr double rounding = 1e-15;

// Blocks of two neighbouring bands: the first, and the one before.
class Bands {
public:
    Bands(const double* first, const double* before, int l)
        : first_(first), before_(before), l_(l) {}

    // P of order `i` of the first band and order `a` of the band before, for the column n.
    double p(int i, int a, int n) const {
        if (n == l_) return one(i, 1) * last(a, l_ - 1) - one(i, -1) * last(a, 1 - l_);
        if (n == -l_) return one(i, 1) * last(a, 1 - l_) + one(i, -1) * last(a, l_ - 1);
        return one(i, 0) * last(a, n);
    }

private:
    double one(int to, int from) const { return first_[3 * (to + 1) + from + 1]; }
    double last(int to, int from) const {
        return before_[(2 * l_ - 1) * (to + l_ - 1) + from + l_ - 1];
    }
    const double *first_, *before_;
    int l_;
};

double entry_of(const Bands& bands, int l, int m, int n) {
    const int am = std::abs(m);
    const double d = std::abs(n) < l ? (l + n) * (l - n) : 2.0 * l * (2.0 * l - 1.0);
    const double u = std::sqrt((l + m) * (l - m) / d);
    const double v =
        std::sqrt((m == 0 ? 2.0 : 1.0) * (l + am - 1) * (l + am) / d) * (m == 0 ? -0.5 : 0.5);
    const double w = m == 0 ? 0.0 : -0.5 * std::sqrt((l - am - 1) * (l - am) / d);

    // Entries of the band before exist for |order| < l alone: where they do not, the factor is 0.
    double sum = 0.0;
    if (am < l) sum += u * bands.p(0, m, n);
    if (m == 0) {
        sum += v * (bands.p(1, 1, n) + bands.p(-1, -1, n));
    } else if (m > 0) {
        sum += v * (m == 1 ? std::sqrt(2.0) * bands.p(1, 0, n)
                           : bands.p(1, m - 1, n) - bands.p(-1, 1 - m, n));
    } else {
        sum += v * (m == -1 ? std::sqrt(2.0) * bands.p(-1, 0, n)
                            : bands.p(1, m + 1, n) + bands.p(-1, -m - 1, n));
    }
    if (m != 0 && am < l - 1)
        sum += w * (m > 0 ? bands.p(1, m + 1, n) + bands.p(-1, -m - 1, n)
                          : bands.p(1, m - 1, n) - bands.p(-1, 1 - m, n));
    return sum;
}

void need_orthogonal(const glm::dmat3& matrix) {
    const glm::dmat3 product = glm::transpose(matrix) * matrix;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (!(std::abs(product[i][j] - (i == j ? 1.0 : 0.0)) <= 1e-5))
                throw Error("sh: a rotation by a matrix that is not orthogonal: columns " +
                            std::to_string(i) + " and " + std::to_string(j) + " have the product " +
                            std::to_string(product[i][j]));
}

}  // namespace

Rotation::Rotation(const glm::dmat3& matrix, int bands) : bands_(bands) {
    need_bands(bands);
    need_orthogonal(matrix);
    blocks_.assign(static_cast<std::size_t>(rotation_block(bands)), 0.0);
    blocks_[0] = 1.0;
    if (bands == 1) return;
    const int axis[3] = {1, 2, 0};  // of orders -1, 0, 1: y, z, x
    double* first = blocks_.data() + rotation_block(1);
    for (int to = 0; to < 3; ++to)
        for (int from = 0; from < 3; ++from) first[3 * to + from] = matrix[axis[from]][axis[to]];
    for (int l = 2; l < bands; ++l) {
        const Bands known(first, blocks_.data() + rotation_block(l - 1), l);
        double* block = blocks_.data() + rotation_block(l);
        for (int to = -l; to <= l; ++to)
            for (int from = -l; from <= l; ++from) {
                const double entry = entry_of(known, l, to, from);
                *block++ = std::abs(entry) < rounding ? 0.0 : entry;
            }
    }
}

double Rotation::entry(int l, int to, int from) const {
    return blocks_[static_cast<std::size_t>(rotation_block(l) + (2 * l + 1) * (to + l) + from + l)];
}

}  // namespace clgi::sh
