// SPDX-License-Identifier: BSD-3-Clause
// RGL materials. The writer here finds the normal that a sample is turned into by integrating the density of visible
// normals cell by cell, and by bisection; the reader has closed forms.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "given/foreign.hpp"
#include "given/random_model.hpp"
#include "given/tensor_file.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"

namespace mmbrdf {
namespace {

constexpr double pi = std::numbers::pi;

/// Rows of nodes over the unit square, in single precision as in the file.
struct Nodes {
  std::size_t nx, ny;
  std::vector<double> values;

  double operator()(double x, double y) const {
    const double a = std::min(std::floor(x * double(nx - 1)), double(nx - 2)), s = x * double(nx - 1) - a;
    const double b = std::min(std::floor(y * double(ny - 1)), double(ny - 2)), t = y * double(ny - 1) - b;
    const auto node = [&](double column, double row) { return values[std::size_t(row) * nx + std::size_t(column)]; };
    return node(a, b) * (1 - s) * (1 - t) + node(a + 1, b) * s * (1 - t) + node(a, b + 1) * (1 - s) * t +
           node(a + 1, b + 1) * s * t;
  }
};

Nodes nodes(std::size_t nx, std::size_t ny, const std::function<double(double, double)>& f) {
  Nodes result{nx, ny, {}};
  for (std::size_t y = 0; y < ny; ++y)
    for (std::size_t x = 0; x < nx; ++x)
      result.values.push_back(static_cast<float>(f(double(x) / double(nx - 1), double(y) / double(ny - 1))));
  return result;
}

/// Of a function that is linear within each of `cells` equal parts of [0, 1], from 0 to u: Simpson's rule is exact.
double integral(const std::function<double(double)>& f, std::size_t cells, double u) {
  double sum = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    const double a = double(c) / double(cells), b = std::min(double(c + 1) / double(cells), u);
    if (b > a) sum += (b - a) / 6 * (f(a) + 4 * f((a + b) / 2) + f(b));
  }
  return sum;
}

double place(const std::function<double(double)>& f, std::size_t cells, double part) {
  double low = 0, high = 1;
  for (int n = 0; n < 60; ++n) {
    const double middle = (low + high) / 2;
    (integral(f, cells, middle) < part * integral(f, cells, 1) ? low : high) = middle;
  }
  return (low + high) / 2;
}

struct Material {
  std::vector<double> theta_i, phi_i;
  std::vector<float> nm;  // none: rgb
  bool isotropic;
};

constexpr std::size_t samples_per_side = 5;

double scale(std::size_t wavelength) { return 1 + 0.5 * double(wavelength); }

std::vector<TensorArray> fields(const Material& material, const Brdf& f) {
  const auto ndf = nodes(6, 4, [](double x, double y) { return 2 - x + 0.3 * std::sin(5 * y); });
  const auto sigma = nodes(4, 3, [](double x, double y) { return 1 - 0.4 * x + 0.1 * y; });
  const std::size_t colours = material.nm.empty() ? 3 : material.nm.size();
  std::vector<double> vndf, spectra;
  for (const double phi : material.phi_i)
    for (const double theta : material.theta_i) {
      const auto density =
          nodes(7, 5, [&](double x, double y) { return 0.2 + (1 - x) * (1 + std::cos(6 * y + phi)) + theta * x; });
      vndf.insert(vndf.end(), density.values.begin(), density.values.end());
      const Vector i = at(theta, phi);
      for (std::size_t w = 0; w < colours; ++w)
        for (std::size_t row = 0; row < samples_per_side; ++row)
          for (std::size_t column = 0; column < samples_per_side; ++column) {
            const double sx = double(column) / (samples_per_side - 1), sy = double(row) / (samples_per_side - 1);
            const auto of_row = [&](double y) { return integral([&](double x) { return density(x, y); }, 6, 1); };
            const double v = place(of_row, 4, sy), u = place([&](double x) { return density(x, v); }, 6, sx);
            const Vector m = at(u * u * pi / 2, (2 * v - 1) * pi + (material.isotropic ? phi : 0));
            const Vector o = sum(2 * dot(m, i), m, -1, i);
            const double s = sigma(std::sqrt(theta * 2 / pi), (phi + pi) / (2 * pi));
            spectra.push_back(o[2] > 0 ? 4 * s * scale(w) * f(i, o) * o[2] / ndf(u, v) : 0);
          }
    }
  const std::uint64_t n_p = material.phi_i.size(), n_t = material.theta_i.size(), side = samples_per_side;
  std::string wavelengths;
  for (const float one : material.nm) append(wavelengths, one);
  std::vector<TensorArray> all{
      {"description", 1, {4}, "test"},
      {"theta_i", 10, {n_t}, singles(material.theta_i)},
      {"phi_i", 10, {n_p}, singles(material.phi_i)},
      {"ndf", 10, {4, 6}, singles(ndf.values)},
      {"sigma", 10, {3, 4}, singles(sigma.values)},
      {"vndf", 10, {n_p, n_t, 5, 7}, singles(vndf)},
      {material.nm.empty() ? "rgb" : "spectra", 10, {n_p, n_t, colours, side, side}, singles(spectra)},
      {"jacobian", 1, {1}, "\1"}};
  if (!material.nm.empty()) all.push_back({"wavelengths", 10, {colours}, wavelengths});
  return all;
}

std::vector<double> as_singles(std::vector<double> values) {
  for (double& value : values) value = static_cast<float>(value);
  return values;
}

const Material turned_about{as_singles({0.05, 0.6, 1.1}), as_singles({-3, -1, 0.5, 2.5}), {450, 532.5F}, false};
const Material same_all_round{as_singles({0.05, 0.6, 1.1}), {0}, {}, true};

/// Spectra are in single precision, 6e-8, and samples at the sides of the square are moved inwards by as much, which f cos
/// feels some tens of times where the detector is low.
constexpr double single = 1e-5;

TEST(Rgl, GivesTheBrdfOfEachSampleOfNormals) {
  const Folder folder;
  put(folder / "x", tensor_file(fields(turned_about, oriented)));
  const ForeignRead read = read_foreign_file(folder / "x");
  EXPECT_GE(read.samples.size(), 200U);
  for (const Sample& s : read.samples) {
    const double part = s.wavelength == 0.45 ? scale(0) : scale(1);
    ASSERT_NEAR(s.f11, part * oriented(to_source(s), to_detector(s)), single);
  }
  EXPECT_TRUE(says(read.understood, {"an RGL .bsdf file: 3 theta_i, 4 phi_i, 5 x 5 samples", "at 450 and 532.5 nm",
                                     "spectra * ndf / (4 sigma cos(theta_r)) = f11"}));
}

TEST(Rgl, IsIsotropicIfItHasOneAzimuthAndIsToldTheWavelengthsOfColours) {
  const Folder folder;
  put(folder / "x", tensor_file(fields(same_all_round, isotropic)));
  EXPECT_TRUE(says(foreign_refusal(folder / "x"), {"x: does not say the wavelength of its 3 colours"}));
  const ForeignRead read = read_foreign_file(folder / "x", {0.61, 0.55, 0.465});
  EXPECT_GE(read.samples.size(), 60U);
  for (const Sample& s : read.samples) {
    const std::size_t w = s.wavelength == 0.61 ? 0 : s.wavelength == 0.55 ? 1 : 2;
    ASSERT_NEAR(s.f11, scale(w) * isotropic(to_source(s), to_detector(s)), single);
    EXPECT_EQ(s.geometry.incident.phi, 0);
  }
}

TEST(Rgl, IsRefusedInOneLineIfItIsCutOffOrWrong) {
  const Folder folder;
  const std::string path = folder / "x";
  const std::vector<TensorArray> good = fields(turned_about, oriented);
  put(path, tensor_file(good));
  expect_refused_where_cut(path);
  EXPECT_TRUE(says(foreign_refusal(path, {0.5}), {"x: says its wavelengths itself"}));
  const auto refusal = [&](std::size_t field, const std::function<void(TensorArray&)>& change) {
    std::vector<TensorArray> changed = good;
    change(changed[field]);
    put(path, tensor_file(changed));
    return foreign_refusal(path);
  };
  EXPECT_TRUE(says(refusal(5, [](TensorArray& f) { f.shape = {4, 3, 7}; }), {"field vndf: must have 4 axes"}));
  EXPECT_TRUE(says(refusal(5,
                           [](TensorArray& f) {
                             f.shape = {3, 4, 5, 7};
                           }),
                   {"field vndf: shape [3, 4, 5, 7], but"}));
  EXPECT_TRUE(says(refusal(6, [](TensorArray& f) { f.shape[4] = 1ULL << 60; }), {"field spectra: shape", "cut off?"}));
  EXPECT_TRUE(says(refusal(3, [](TensorArray& f) { f.shape = {24, 1}; }), {"field ndf: must have 2 axes"}));
  EXPECT_TRUE(
      says(refusal(5, [](TensorArray& f) { f.data.replace(0, 4, singles({-1})); }), {"field vndf: -1 is no density"}));
  EXPECT_TRUE(says(refusal(1,
                           [](TensorArray& f) {
                             f.data = singles({10, 30, 60});
                           }),
                   {"field theta_i: 10 is not in [0, 1.5708]"}));
  EXPECT_TRUE(says(refusal(8,
                           [](TensorArray& f) {
                             f.data = singles({0.45, 0.53});
                           }),
                   {"field wavelengths: 0.4", "is no wavelength"}));
  EXPECT_TRUE(says(refusal(4, [](TensorArray& f) { f.name = "other"; }), {"x: no field sigma"}));
  const auto longer = [](TensorArray& f) {
    f.shape = {20000};
    f.data = std::string(4 * 20000, '\0');
  };
  EXPECT_TRUE(says(refusal(1, longer), {"field theta_i: 20000 nodes of an axis, must be at most 10000"}));
  for (const auto& [shape, field, message] :
       {std::tuple{std::vector<std::uint64_t>{4, 3, 2, 5}, 6U,
                   "field spectra: must have 5 axes, the last two of 2 nodes"},
        {std::vector<std::uint64_t>{4, 3, 2, 5, 1}, 6U, "field spectra: must have 5 axes, the last two of 2 nodes"},
        {std::vector<std::uint64_t>{4, 3, 2, 1, 5}, 6U, "field spectra: must have 5 axes, the last two of 2 nodes"},
        {std::vector<std::uint64_t>{4, 3, 1, 5, 5}, 6U, "field spectra: shape [4, 3, 1, 5, 5], but the axes ask for"},
        {std::vector<std::uint64_t>{4, 3, 1, 7}, 5U, "field vndf: must have 4 axes, the last two of 2 nodes"},
        {std::vector<std::uint64_t>{4, 3, 6, 1}, 5U, "field vndf: must have 4 axes, the last two of 2 nodes"},
        {std::vector<std::uint64_t>{3, 1}, 4U, "field sigma: must have 2 axes, the last two of 2 nodes"}})
    EXPECT_TRUE(says(refusal(field, [shape = shape](TensorArray& f) { f.shape = shape; }), {message}));
  EXPECT_TRUE(says(refusal(3, [](TensorArray& f) { f.data.replace(0, 4, singles({HUGE_VAL})); }),
                   {"field ndf: inf is no density"}));
  EXPECT_TRUE(says(refusal(7, longer), {"field jacobian: must have the shape [1]"}));
}

std::string exported(const Export& table) {
  std::ostringstream out;
  table.write(out);
  return out.str();
}

/// As a renderer reads such a file: half directions are turned into samples of the square by the density of visible
/// normals, with integrals of its own; what is between nodes is linear.
class Renderer {
 public:
  explicit Renderer(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 14), std::string("tensor_file\0\1\0", 14));
    std::size_t place = 14;
    const auto take = [&]<class Number>(Number value) {
      std::memcpy(&value, bytes.data() + place, sizeof value);
      place += sizeof value;
      return value;
    };
    for (std::uint32_t f = take(std::uint32_t{}); f > 0; --f) {
      const std::uint16_t length = take(std::uint16_t{});
      const std::string name = bytes.substr(place, length);
      place += length;
      const std::uint16_t dimensions = take(std::uint16_t{});
      const int type = take(std::uint8_t{});
      const std::uint64_t offset = take(std::uint64_t{});
      std::size_t count = 1;
      for (int d = 0; d < dimensions; ++d) count *= shapes[name].emplace_back(take(std::uint64_t{}));
      for (std::size_t n = 0; n < count && type == 1; ++n) text[name] += bytes.at(offset + n);
      if (type == 1) continue;
      EXPECT_EQ(type, 10) << name;
      std::vector<float> all(count);
      std::memcpy(all.data(), bytes.data() + offset, 4 * count);
      values[name].assign(all.begin(), all.end());
      if (dimensions > 1) cut(name);
    }
  }

  /// f cos(theta_r) for light from theta_i at azimuth 0.
  double f_cos(double theta_i, const Vector& o, std::size_t w) const {
    const auto [u, v] = half(theta_i, o);
    const std::pair<double, double> xy = sample(theta_i, u, v);
    const std::size_t count = shapes.at("wavelengths")[0];
    const double spectrum =
        of_incidence(theta_i, [&](std::size_t t) { return slice("spectra", t * count + w)(xy.first, xy.second); });
    return spectrum * slice("ndf", 0)(u, v) / (4 * slice("sigma", 0)(std::sqrt(theta_i * 2 / pi), 0.5));
  }

  /// Of drawing o: a sample by luminance, and by it a half direction.
  double pdf(double theta_i, const Vector& o) const {
    const auto [u, v] = half(theta_i, o);
    const auto [x, y] = sample(theta_i, u, v);
    const auto of = [&](const char* name, double a, double b) {
      return of_incidence(theta_i, [&](std::size_t t) { return slice(name, t)(a, b) / totals.at(name)[t]; });
    };
    const Vector i = at(theta_i, 0), h = unit(sum(1, i, 1, o));
    return of("luminance", x, y) * of("vndf", u, v) / (2 * pi * pi * u * std::hypot(h[0], h[1]) * 4 * dot(i, h));
  }

  std::map<std::string, std::vector<std::uint64_t>> shapes;
  std::map<std::string, std::vector<double>> values;
  std::map<std::string, std::string> text;

 private:
  static std::pair<double, double> half(double theta_i, const Vector& o) {
    const Vector h = sum(1, at(theta_i, 0), 1, o);
    return {std::sqrt(std::atan2(std::hypot(h[0], h[1]), h[2]) * 2 / pi), std::atan2(h[1], h[0]) / (2 * pi) + 0.5};
  }

  void cut(const std::string& name) {
    const std::vector<std::uint64_t>& shape = shapes.at(name);
    const std::size_t nx = shape.back(), ny = shape[shape.size() - 2];
    for (auto first = values[name].begin(); first != values[name].end(); first += std::ptrdiff_t(nx * ny)) {
      slices[name].push_back({nx, ny, {first, first + std::ptrdiff_t(nx * ny)}});
      totals[name].push_back(total(slices[name].back()));
    }
  }
  const Nodes& slice(const std::string& name, std::size_t number) const { return slices.at(name)[number]; }

  static double total(const Nodes& density) {
    return integral([&](double y) { return of_row(density, y, 1); }, density.ny - 1, 1);
  }
  static double of_row(const Nodes& density, double y, double to) {
    return integral([&](double x) { return density(x, y); }, density.nx - 1, to);
  }

  std::map<std::string, std::vector<Nodes>> slices;
  std::map<std::string, std::vector<double>> totals;

  double of_incidence(double theta_i, const std::function<double(std::size_t)>& value) const {
    const std::vector<double>& nodes = values.at("theta_i");
    std::size_t t = 0;
    while (t + 2 < nodes.size() && nodes[t + 1] < theta_i) ++t;
    const double part = (theta_i - nodes[t]) / (nodes[t + 1] - nodes[t]);
    return (1 - part) * value(t) + part * value(t + 1);
  }

  std::pair<double, double> sample(double theta_i, double u, double v) const {
    const auto mean = [&](const std::function<double(const Nodes&)>& of) {
      return of_incidence(theta_i, [&](std::size_t t) { return of(slice("vndf", t)) / totals.at("vndf")[t]; });
    };
    const double y = mean([&](const Nodes& density) {
      return integral([&](double row) { return of_row(density, row, 1); }, density.ny - 1, v);
    });
    return {
        mean([&](const Nodes& d) { return of_row(d, v, u); }) / mean([&](const Nodes& d) { return of_row(d, v, 1); }),
        y};
  }
};

struct Drawn {
  double theta_i;
  Vector o;
  double theta_r, phi_r;
};

std::vector<Drawn> directions(std::size_t count, double theta_max) {
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> part(0, 1);
  std::vector<Drawn> result;
  while (result.size() < count) {
    const double ti = std::asin(std::sin(theta_max) * std::sqrt(part(engine))),
                 tr = std::asin(std::sin(theta_max) * std::sqrt(part(engine))), phi = 2 * pi * part(engine);
    result.push_back({ti, at(tr, phi), tr, phi});
  }
  return result;
}

TEST(Rgl, IsWrittenWithTheErrorThatItSays) {
  const Model model = material("ptfe");
  for (const auto& [wanted, side] : {std::pair{1e-2, 33U}, std::pair{2.5e-3, 65U}}) {
    const Export table(model, export_format("rgl"), {.wavelengths = {0.45, 0.633}, .error = wanted});
    const Renderer renderer(exported(table));
    EXPECT_EQ(renderer.shapes.at("spectra")[4], side);
    EXPECT_EQ(renderer.shapes.at("luminance")[2], side);
    EXPECT_EQ(renderer.values.at("wavelengths"), (std::vector<double>{450, 633}));
    EXPECT_EQ(renderer.text.at("jacobian"), "\1");
    double squares = 0, largest = 0;
    constexpr std::size_t count = 2000;
    for (const std::size_t w : {0U, 1U}) {
      const PreparedModel prepared = prepare(model, w == 0 ? 0.45 : 0.633);
      for (const Drawn& d : directions(count, table.error().theta_max)) {
        const double error =
            renderer.f_cos(d.theta_i, d.o, w) / d.o[2] / prepared.f11({{d.theta_i, 0}, {d.theta_r, d.phi_r}}) - 1;
        squares += error * error;
        largest = std::max(largest, std::abs(error));
      }
    }
    // Other directions of the same distribution.
    EXPECT_LE(table.error().rms, wanted);
    EXPECT_NEAR(std::sqrt(squares / (2 * count)), table.error().rms, 0.2 * table.error().rms);
    EXPECT_LT(largest, 2 * table.error().largest);
  }
}

TEST(Rgl, ThatIsWrittenIsDrawnNearlyAsItScatters) {
  const Model model = material("ptfe-532");
  const PreparedModel prepared = prepare(model, 0.532);
  const Renderer renderer(exported(Export(model, export_format("rgl"), {.error = 2.5e-3})));
  double squares = 0;
  const std::vector<Drawn> drawn = directions(400, radians(70));
  for (const Drawn& d : drawn) {
    const double part = prepared.f11({{d.theta_i, 0}, {d.theta_r, d.phi_r}}) * d.o[2] /
                        directional_hemispherical_reflectance(model, 0.532, {d.theta_i, 0});
    squares += std::pow(renderer.pdf(d.theta_i, d.o) / part - 1, 2);
  }
  // With 65 nodes a side: the density is off by some percent, and far more only near the mirror direction.
  EXPECT_LT(std::sqrt(squares / double(drawn.size())), 0.1);
}

TEST(Rgl, ThatIsWrittenIsReadBackAsTheModel) {
  const Folder folder;
  for (const Model& model : {material("ptfe"), random_model(Family::isotropic, {4, 3}, 0, 3)}) {
    put(folder / "x", exported(Export(model, export_format("rgl"), {.wavelengths = {0.532}, .error = 10})));
    const ForeignRead read = read_foreign_file(folder / "x");
    const PreparedModel prepared = prepare(model, 0.532);
    EXPECT_GE(read.samples.size(), 4000U);
    for (const Sample& s : read.samples) {
      // Single precision of f cos and of angles, and samples at the sides of the square moved inwards by as much.
      const double lowest = std::cos(s.geometry.reflected.theta);
      ASSERT_NEAR(s.f11, prepared.f11(s.geometry), 1e-6 + 1e-7 / lowest);
    }
  }
}

TEST(Rgl, ThatIsWrittenHasADensityEvenOfWhatIsBlack) {
  const Export table(diffuser({-0.3}), export_format("rgl"), {.wavelengths = {0.5}, .error = 1});
  const Renderer renderer(exported(table));
  for (const double bright : renderer.values.at("luminance")) ASSERT_EQ(bright, 1);
}

TEST(Rgl, ThatIsWrittenSaysHowManyOfItsValuesAreNegative) {
  const auto text = [](const Model& model) {
    return Export(model, export_format("rgl"), {.wavelengths = {0.5, 0.6}, .error = 1}).understood();
  };
  // Of two wavelengths both, or the second: 0.55 − λ.
  const std::string dark = text(diffuser({-0.3})), half = text(diffuser({0.55, -1}));
  const auto counts = [](const std::string& of) {
    std::array<double, 2> result{};
    const std::size_t at = of.find("; densities of normals are constants; ");
    EXPECT_NE(at, std::string::npos) << of;
    EXPECT_EQ(
        std::sscanf(of.c_str() + at, "; densities of normals are constants; %lf of %lf values", &result[0], &result[1]),
        2)
        << of;
    return result;
  };
  EXPECT_EQ(counts(dark)[0], counts(dark)[1]);
  EXPECT_EQ(2 * counts(half)[0], counts(half)[1]);
  EXPECT_EQ(text(diffuser({0.3})).find("negative"), std::string::npos);
}

TEST(Rgl, IsNotWrittenOfWhatItCannotHold) {
  EXPECT_TRUE(says(export_refusal(material("ptfe"), "rgl", {.error = 1e-9}),
                   {"the finest table, of 73 theta_i, 257 x 257 half directions"}));
  EXPECT_TRUE(says(export_refusal(random_model(Family::anisotropic, {2, 1}, 0, 1), "rgl", {.wavelengths = {0.5}}),
                   {"an RGL file is of an isotropic sample"}));
}

}  // namespace
}  // namespace mmbrdf
