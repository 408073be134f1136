// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/model/moments.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "mmbrdf/model/description.hpp"
#include "model/kernel/plan.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

std::size_t counter(int n) { return static_cast<std::size_t>(n); }

/// Σ_m c_m cos m δ + s_m sin m δ; as many c as s.
struct Series {
  std::vector<double> c, s;
  explicit Series(int degree) : c(counter(degree) + 1), s(c.size()) {}

  /// weight × (a cos m δ + b sin m δ), m of any sign.
  void add(int m, double a, double b) {
    c[counter(std::abs(m))] += a;
    if (m != 0) s[counter(std::abs(m))] += m < 0 ? -b : b;
  }
};

/// Adds weight × x y.
void add_product(const Series& x, const Series& y, double weight, Series& sum) {
  for (int a = 0; a < static_cast<int>(x.c.size()); ++a)
    for (int b = 0; b < static_cast<int>(y.c.size()); ++b) {
      const double xc = x.c[counter(a)], xs = x.s[counter(a)], yc = y.c[counter(b)], ys = y.s[counter(b)];
      sum.add(a - b, weight * (xc * yc + xs * ys) / 2, weight * (xs * yc - xc * ys) / 2);
      sum.add(a + b, weight * (xc * yc - xs * ys) / 2, weight * (xs * yc + xc * ys) / 2);
    }
}

/// cos 2δ, sin 2δ: what turns xy into sp.
Series turn(bool sine) {
  Series result(2);
  (sine ? result.s : result.c)[2] = 1;
  return result;
}

struct RadialAndAzimuthal {
  int n, k;
};

RadialAndAzimuthal orders_of(int index) {  // of zernike_index
  int n = 0;
  while ((n + 1) * (n + 2) / 2 <= index) ++n;
  return {n, 2 * index - n * (n + 2)};
}

/// weight × K(incident at azimuth 0) × R(reflected) × cos or, for k < 0, sin of |k| δ, added to an element.
struct AzimuthalTerm {
  std::size_t element, incident, reflected;
  int k;
  double weight;
};

/// The terms of a model at phi_i = 0, where sines of phi_i are 0.
std::vector<AzimuthalTerm> azimuthal_terms(const PreparedModel& model) {
  const PreparedPattern& pattern = Evaluation::pattern(model);
  const std::span<const double> coefficients = model.coefficients();
  std::vector<AzimuthalTerm> result;
  for (std::size_t q = 0; q < pattern.modes(); ++q)
    for (std::size_t t = pattern.terms_end[q]; t < pattern.terms_end[q + 1]; ++t) {
      const Term& term = pattern.terms[t];
      const auto [n, k] = orders_of(term.reflected);
      if (orders_of(term.incident).k >= 0)
        result.push_back({term.element(), counter(term.incident), counter(zernike_index(n, std::abs(k))), k,
                          term.weight * coefficients[q]});
    }
  return result;
}

int degree_of(const std::vector<AzimuthalTerm>& terms, bool f11) {
  int degree = -1;
  for (const AzimuthalTerm& term : terms)
    if ((term.element == 0) == f11) degree = std::max(degree, std::abs(term.k));
  return degree;
}

int degree_of(const std::vector<AzimuthalTerm>& terms) {
  const int of_others = degree_of(terms, false);
  return degree_of(terms, true) + (of_others < 0 ? 0 : of_others + 2);
}

void require_one_azimuth(const PreparedModel& model) {
  const PreparedPattern& pattern = Evaluation::pattern(model);
  if (!pattern.isotropic_f11)
    throw std::invalid_argument("Fourier moments are those of an isotropic sample, and " +
                                azimuth_of_source_line(pattern.family));
}

/// All K_n^k, k ≥ 0, at azimuth 0.
std::vector<double> radial_table(const PreparedModel& model, double mu, const char* name) {
  if (!(mu >= 0 && mu <= 1))
    throw std::invalid_argument(std::string(name) + " = " + shortest(mu) + ", a cosine must be in 0...1");
  const PreparedPattern& pattern = Evaluation::pattern(model);
  std::vector<double> table(counter(zernike_count(pattern.plan.order)));
  const Vector3 v{std::sqrt((1 - mu) * (1 + mu)), 0, mu};
  zernike_table(pattern.plan.order, disc_point(v, pattern.mapping), table.data());
  return table;
}

/// What is the same at all cosines.
class Moments {
 public:
  explicit Moments(const PreparedModel& model)
      : terms_(azimuthal_terms(model)),
        of_f11_(degree_of(terms_, true)),
        of_others_(std::max(0, degree_of(terms_, false))),
        degree_(degree_of(terms_)),
        reflectance_(model.reflectance()),
        unknown_(turned_into(Evaluation::pattern(model).unknown)) {}

  FourierMoments at(const std::vector<double>& incident, const std::vector<double>& reflected) const {
    std::vector<Series> m = normalized(incident, reflected);
    Series f11(of_f11_);
    for (const AzimuthalTerm& term : terms_)
      if (term.element == 0) add(term, incident, reflected, reflectance_, f11);
    m[0].c[0] = 1;
    FourierMoments result{std::vector<Mueller>(counter(degree_) + 1), std::vector<Mueller>(counter(degree_) + 1)};
    for (std::size_t e = 0; e < 16; ++e) {
      Series f(of_f11_ + of_others_ + 2);
      add_product(f11, m[e], 1, f);
      const double nan = std::numeric_limits<double>::quiet_NaN();
      for (std::size_t k = 0; k < result.cosine.size(); ++k) {
        result.cosine[k].elements[e] = unknown_[e] ? nan : f.c[k];
        result.sine[k].elements[e] = unknown_[e] ? nan : f.s[k];
      }
    }
    return result;
  }

  int degree() const { return degree_; }

 private:
  static void add(const AzimuthalTerm& term, const std::vector<double>& incident, const std::vector<double>& reflected,
                  double factor, Series& sum) {
    const double value = factor * term.weight * incident[term.incident] * reflected[term.reflected];
    (term.k < 0 ? sum.s : sum.c)[counter(std::abs(term.k))] += value;
  }

  /// f_ij / f11 in the frame sp but for element 11, which is left 0.
  std::vector<Series> normalized(const std::vector<double>& incident, const std::vector<double>& reflected) const {
    std::vector<Series> xy(16, Series(of_others_)), sp(16, Series(of_others_ + 2));
    for (const AzimuthalTerm& term : terms_)
      if (term.element != 0) add(term, incident, reflected, 1, xy[term.element]);
    const Series cosine = turn(false), sine = turn(true);
    for (std::size_t column = 0; column < 4; ++column) {  // R(δ) M_xy (theory 1.1)
      for (const std::size_t row : {0U, 3U})
        for (std::size_t k = 0; k < xy[0].c.size(); ++k)
          sp[4 * row + column].c[k] = xy[4 * row + column].c[k], sp[4 * row + column].s[k] = xy[4 * row + column].s[k];
      add_product(cosine, xy[4 + column], 1, sp[4 + column]);
      add_product(sine, xy[8 + column], 1, sp[4 + column]);
      add_product(sine, xy[4 + column], -1, sp[8 + column]);
      add_product(cosine, xy[8 + column], 1, sp[8 + column]);
    }
    return sp;
  }

  std::vector<AzimuthalTerm> terms_;
  int of_f11_, of_others_, degree_;
  double reflectance_;
  Elements unknown_;
};

}  // namespace

int highest_moment(const PreparedModel& model) {
  require_one_azimuth(model);
  return degree_of(azimuthal_terms(model));
}

bool is_its_own_mirror_image(const PreparedModel& model) {
  require_one_azimuth(model);
  return std::ranges::all_of(azimuthal_terms(model), [](const AzimuthalTerm& term) {
    const bool odd_element = (term.element < 8) != (term.element % 4 < 2);
    return (term.k < 0) == odd_element;
  });
}

std::vector<FourierMoments> fourier_moments(const PreparedModel& model, std::span<const double> mu_incident,
                                            std::span<const double> mu_reflected) {
  require_one_azimuth(model);
  std::vector<std::vector<double>> incident, reflected;
  for (const double mu : mu_incident) incident.push_back(radial_table(model, mu, "mu_incident"));
  for (const double mu : mu_reflected) reflected.push_back(radial_table(model, mu, "mu_reflected"));
  const Moments moments(model);
  std::vector<FourierMoments> result;
  for (const std::vector<double>& r : reflected)
    for (const std::vector<double>& i : incident) result.push_back(moments.at(i, r));
  return result;
}

FourierMoments fourier_moments(const PreparedModel& model, double mu_incident, double mu_reflected) {
  return fourier_moments(model, {&mu_incident, 1}, {&mu_reflected, 1}).front();
}

Mueller resummed(const FourierMoments& moments, double phi) {
  Mueller sum{};
  for (std::size_t m = 0; m < moments.cosine.size(); ++m) {
    const double angle = static_cast<double>(m) * phi;
    sum = sum + std::cos(angle) * moments.cosine[m] + std::sin(angle) * moments.sine[m];
  }
  return sum;
}

}  // namespace mmbrdf
