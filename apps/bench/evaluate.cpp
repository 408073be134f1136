// SPDX-License-Identifier: BSD-3-Clause
// The kernels of every instruction set that runs here, on data in the cache, from unit vectors to xy.
#include <algorithm>
#include <cmath>
#include <random>

#include "bench.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "model/kernel/layouts.hpp"
#include "model/kernel/plan.hpp"
#include "models.hpp"

namespace mmbrdf::bench {
namespace {

/// A model as a kernel takes it, in the precision T.
template <class T>
struct Arranged {
  Plan plan;
  std::vector<T> coefficients;
  int modes = 0;

  /// All powers of the wavelength, or only λ⁰ of them.
  Arranged(const Model& model, bool all_powers) : plan(mmbrdf::plan(model)) {
    const std::vector<double> of_modes = by_powers(model);
    const std::size_t count = of_modes.size() / static_cast<std::size_t>(model.powers + 1);
    modes = static_cast<int>(count);
    for (std::size_t first = 0; first < (all_powers ? of_modes.size() : count); first += count)
      for (const double a : plan.coefficients(std::span(of_modes).subspan(first, count)))
        coefficients.push_back(static_cast<T>(a));
  }
  KernelModel<T> model(int powers) const { return kernel_model<T>(plan, coefficients, powers, T(1)); }
};

enum class Layout { columns, matrices };

/// Points and room for their matrices.
template <class T>
struct Data {
  std::vector<T> in, wavelengths, scales, out;
  KernelPoints<T> points{};
  KernelMatrices<T> matrices{};

  Data(std::size_t count, Layout layout) : in(6 * count), out(16 * count) {
    const std::vector<Geometry> geometries = random_geometries(static_cast<int>(count), 1);
    for (std::size_t q = 0; q < count; ++q) {
      const Vector3 i = unit_vector(geometries[q].incident), r = unit_vector(geometries[q].reflected);
      for (std::size_t j = 0; j < 3; ++j) {
        in[j * count + q] = static_cast<T>(i[j]);
        in[(3 + j) * count + q] = static_cast<T>(r[j]);
      }
      wavelengths.push_back(T(0.351 + 0.7 * static_cast<double>(q) / static_cast<double>(count)));
      scales.push_back(T(0.98));
    }
    for (std::size_t j = 0; j < 6; ++j) points.column[j] = in.data() + j * count;
    points.stride = 1;
    for (std::size_t e = 0; e < 16; ++e)
      matrices.element[e] = layout == Layout::columns ? out.data() + e * count : out.data() + e;
    matrices.stride = layout == Layout::columns ? 1 : 16;
  }
};

template <class T>
void evaluate(benchmark::State& state, const Kernel& kernel, const KernelModel<T>& model, const Data<T>& data,
              std::size_t count, int coefficients) {
  Report report(state);
  for (auto _ : state) {
    if constexpr (sizeof(T) == sizeof(double))
      kernel.evaluate(model, data.points, data.matrices, count);
    else
      kernel.evaluate_single(model, data.points, data.matrices, count);
    benchmark::ClobberMemory();
  }
  report.finish(static_cast<double>(count));
  state.counters["coefficients"] = coefficients;
}

struct Variant {
  const char* benchmark;
  const char* name;
  Family family;
  Orders orders;
  Rotation rotation = Rotation::covariant;
  Layout layout = Layout::columns;
  bool spectral = false;  // a wavelength for each point
  std::size_t count = in_cache;
};

const Variant variants[] = {
    {"evaluate_isotropic", "", Family::isotropic, {7, 4}},
    {"evaluate_isotropic", "/matrices", Family::isotropic, {7, 4}, Rotation::covariant, Layout::matrices},
    {"evaluate_isotropic", "/wavelengths", Family::isotropic, {7, 4}, Rotation::covariant, Layout::columns, true},
    {"evaluate_isotropic", "/points:1", Family::isotropic, {7, 4}, Rotation::covariant, Layout::columns, false, 1},
    {"evaluate_isotropic", "/points:8", Family::isotropic, {7, 4}, Rotation::covariant, Layout::columns, false, 8},
    {"evaluate_isotropic", "/points:100", Family::isotropic, {7, 4}, Rotation::covariant, Layout::columns, false, 100},
    {"evaluate_germer2017", "", Family::germer2017, {7, 4}, Rotation::as_printed},
    {"evaluate_germer2017", "/matrices", Family::germer2017, {7, 4}, Rotation::as_printed, Layout::matrices},
    {"evaluate_germer2017", "/covariant", Family::germer2017, {7, 4}},
    {"evaluate_germer2017", "/wavelengths", Family::germer2017, {7, 4}, Rotation::as_printed, Layout::columns, true},
    {"evaluate_general", "/germer2017/5,5", Family::germer2017, {5, 5}, Rotation::as_printed},
    {"evaluate_general", "/germer2017/8,6", Family::germer2017, {8, 6}, Rotation::as_printed},
    {"evaluate_general", "/isotropic/5,5", Family::isotropic, {5, 5}},
    {"evaluate_general", "/isotropic/8,6", Family::isotropic, {8, 6}},
    {"evaluate_general", "/isotropic/12,12", Family::isotropic, {12, 12}},
    {"evaluate_general", "/isotropic/20,20", Family::isotropic, {20, 20}},
    {"evaluate_general", "/anisotropic/4,4", Family::anisotropic, {4, 4}},
    {"evaluate_general", "/anisotropic/7,4", Family::anisotropic, {7, 4}},
};

template <class T>
void register_variant(const Kernel& kernel, const Variant& v, const char* precision) {
  const std::string name = std::string(v.benchmark) + "/" + kernel.name + "/" + precision + v.name;
  benchmark::RegisterBenchmark(name.c_str(), [&kernel, &v](benchmark::State& state) {
    Model model = bench_model(v.family, v.orders, v.spectral ? 1 : 0);
    model.rotation = v.rotation;
    const Arranged<T> arranged(model, v.spectral);
    Data<T> data(v.count, v.layout);
    if (v.spectral) {
      data.points.wavelength = data.wavelengths.data();
      data.points.scale = data.scales.data();
    }
    evaluate(state, kernel, arranged.model(v.spectral ? 1 : 0), data, v.count, arranged.modes);
  });
}

/// The coefficients of one incident direction, whatever the kernel.
template <class T>
void register_incidence(const Kernel& kernel, const char* precision, Layout layout) {
  const std::string name = std::string("evaluate_prepared_incidence/") + kernel.name + "/" + precision +
                           (layout == Layout::matrices ? "/matrices" : "");
  benchmark::RegisterBenchmark(name.c_str(), [&kernel, layout](benchmark::State& state) {
    const PreparedIncidence prepared = prepare(material("ptfe"), 0.532).at(Direction{radians(45), 0.3});
    const KernelModel<double> from = Evaluation::model(prepared);
    std::vector<T> coefficients;
    for (int i = 0; i < PlaneLayout::count; ++i) coefficients.push_back(static_cast<T>(from.coefficients[i]));
    KernelModel<T> model{};
    model.form = from.form;
    model.turned_by[0] = static_cast<T>(from.turned_by[0]);
    model.turned_by[1] = static_cast<T>(from.turned_by[1]);
    model.coefficients = coefficients.data();
    model.scale = static_cast<T>(from.scale);
    evaluate(state, kernel, model, Data<T>(in_cache, layout), in_cache, PlaneLayout::count);
  });
}

}  // namespace

void register_evaluation() {
  for (const Variant& variant : variants)
    for (const Kernel* kernel : kernels_that_run_here()) {
      register_variant<double>(*kernel, variant, "double");
      register_variant<float>(*kernel, variant, "float");
    }
  for (const Kernel* kernel : kernels_that_run_here())
    for (const Layout layout : {Layout::columns, Layout::matrices}) {
      register_incidence<double>(*kernel, "double", layout);
      register_incidence<float>(*kernel, "float", layout);
    }
}

}  // namespace mmbrdf::bench
