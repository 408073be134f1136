// SPDX-License-Identifier: BSD-3-Clause
// NetCDF, written here with the library's own calls: over a grid with scalar and one-dimensional coordinates, as xarray
// writes it, and over a list of samples.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "given/foreign.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/model/prepared.hpp"

#ifdef MMBRDF_NETCDF
#include <netcdf.h>
#endif

namespace mmbrdf {
namespace {

#ifndef MMBRDF_NETCDF
TEST(Netcdf, IsRefusedInOneLineByABuildWithoutIt) {
  const Folder folder;
  put(folder / "x", std::string("CDF\1", 4) + std::string(100, '\0'));
  EXPECT_TRUE(says(foreign_refusal(folder / "x"), {"x: a NetCDF file, but this build of mmbrdf has no NetCDF"}));
}
#else

struct Variable {
  std::string name;
  std::vector<std::string> axes;
  std::vector<double> values;
  std::map<std::string, std::string> attributes;
};

void write(const std::string& path, const std::map<std::string, std::size_t>& axes,
           const std::vector<Variable>& variables, int format) {
  int file = 0;
  ASSERT_EQ(nc_create(path.c_str(), NC_CLOBBER | format, &file), NC_NOERR);
  std::map<std::string, int> ids;
  for (const auto& [name, length] : axes) nc_def_dim(file, name.c_str(), length, &ids[name]);
  std::vector<int> numbers;
  for (const Variable& one : variables) {
    std::vector<int> dimensions;
    for (const std::string& axis : one.axes) dimensions.push_back(ids.at(axis));
    int id = 0;
    ASSERT_EQ(
        nc_def_var(file, one.name.c_str(), NC_DOUBLE, static_cast<int>(dimensions.size()), dimensions.data(), &id),
        NC_NOERR);
    for (const auto& [name, text] : one.attributes) nc_put_att_text(file, id, name.c_str(), text.size(), text.c_str());
    numbers.push_back(id);
  }
  nc_enddef(file);
  for (std::size_t v = 0; v < variables.size(); ++v) {
    if (variables[v].values.empty()) continue;
    std::vector<std::size_t> start(variables[v].axes.size()), count;
    std::size_t rest = variables[v].values.size();
    for (const std::string& axis : variables[v].axes)
      count.push_back(axes.at(axis)), rest /= std::max<std::size_t>(1, count.back());
    if (!count.empty() && count[0] == NC_UNLIMITED) count[0] = rest;
    ASSERT_EQ(nc_put_vara_double(file, numbers[v], start.data(), count.data(), variables[v].values.data()), NC_NOERR);
  }
  ASSERT_EQ(nc_close(file), NC_NOERR);
}

using Attributes = std::map<std::string, std::string>;

const std::vector<double> theta_i{5, 40, 70}, theta_r{0, 25, 60, 90}, phi_r{0, 80, 180, 290};

/// phi_i = 20 as a scalar, theta_r and phi_r as axes, theta_i as an axis before them.
std::vector<Variable> grid(const PreparedModel& model, Frame frame, const std::string& convention) {
  std::vector<double> values;
  for (const double ti : theta_i)
    for (const double tr : theta_r)
      for (const double pr : phi_r) {
        const Geometry g = in_degrees(ti, 20, tr, pr);
        Mueller m = change_frame(model.evaluate(g), g, Frame::xy, frame);
        if (convention.starts_with("s_first_right"))
          for (int k = 0; k < 3; ++k) m(3, k) = -m(3, k), m(k, 3) = -m(k, 3);
        values.insert(values.end(), m.elements.begin(), m.elements.end());
      }
  return {{"theta_i_deg", {"theta_i_deg"}, theta_i, {{"units", "degree"}}},
          {"theta_r_deg", {"theta_r_deg"}, theta_r, {{"units", "degree"}}},
          {"phi_r_deg", {"phi_r_deg"}, phi_r, {{"units", "degree"}}},
          {"phi_i_deg", {}, {20}, {{"units", "degree"}}},
          {"wavelength_nm", {}, {532}, {{"units", "nm"}}},
          {"brdf",
           {"theta_i_deg", "theta_r_deg", "phi_r_deg", "row", "column"},
           values,
           {{"units", "sr-1"}, {"frame", to_string(frame)}, {"convention", convention}}}};
}

const std::map<std::string, std::size_t> grid_axes{
    {"theta_i_deg", 3}, {"theta_r_deg", 4}, {"phi_r_deg", 4}, {"row", 4}, {"column", 4}};

TEST(Netcdf, GivesMatricesInTheFrameXyWhateverThatOfTheFile) {
  const Folder folder;
  const PreparedModel model = prepare(random_model(Family::isotropic, {5, 4}, 0, 4), 0.532);
  for (const int format : {NC_NETCDF4, NC_64BIT_OFFSET, 0})
    for (const auto& [frame, convention] :
         {std::pair{Frame::xy, "germer2017: S2 = first axis - second axis"}, std::pair{Frame::sp, "s_first_right"}}) {
      write(folder / "x", grid_axes, grid(model, frame, convention), format);
      const ForeignRead read = read_foreign_file(folder / "x");
      ASSERT_EQ(read.samples.size(), 36U);
      for (const Sample& s : read.samples) {
        EXPECT_NEAR(s.geometry.incident.phi / degree, 20, 1e-12);
        const Mueller expected = model.evaluate(s.geometry);
        for (std::size_t e = 0; e < 16; ++e)
          ASSERT_NEAR(s.f11 * s.normalized.elements[e], expected.elements[e], 1e-13) << element_name(e);
      }
      EXPECT_TRUE(
          says(read.understood, {"a NetCDF file: sixteen elements in sr^-1 over (theta_i_deg, theta_r_deg, phi_r_deg)",
                                 "frame " + to_string(frame), "12 of 48 matrices at or below the horizon"}));
    }
}

/// f11 of many samples in one list, more than are read at once, with uncertainties, and one that was never written.
TEST(Netcdf, GivesAListOfSamplesWithUncertainties) {
  const Folder folder;
  constexpr std::size_t count = 150000;
  std::vector<std::vector<double>> columns(6);
  for (std::size_t n = 0; n < count; ++n) {
    const double ti = static_cast<double>(n % 80), pi = static_cast<double>(n % 359), tr = static_cast<double>(n % 77),
                 pr = static_cast<double>(n % 353);
    for (const auto& [c, value] : {std::pair{0, ti}, {1, pi}, {2, tr}, {3, pr}})
      columns[static_cast<std::size_t>(c)].push_back(value);
    columns[4].push_back(n == 7 ? NC_FILL_DOUBLE
                                : oriented(at(ti * degree, pi * degree), at(tr * degree, pr * degree)));
    columns[5].push_back(0.01);
  }
  std::vector<Variable> variables;
  for (const auto& [c, name] : {std::pair{0, "theta_i_deg"}, {1, "phi_i_deg"}, {2, "theta_r_deg"}, {3, "phi_r_deg"}})
    variables.push_back({name, {"sample"}, columns[static_cast<std::size_t>(c)], {}});
  variables.push_back({"brdf", {"sample"}, columns[4], {{"units", "1/sr"}}});
  variables.push_back({"uncertainty", {"sample"}, columns[5], {{"units", "1/sr"}}});
  write(folder / "x", {{"sample", count}}, variables, NC_NETCDF4);
  const ForeignRead read = read_foreign_file(folder / "x", {0.633});
  EXPECT_EQ(read.samples.size(), count - 1);
  expect_values(read.samples, oriented, 1e-14);
  EXPECT_EQ(read.samples[100000].uncertainty(0, 0), 0.01);
  EXPECT_EQ(read.understood,
            "a NetCDF file: f11 in sr^-1 over (sample) at 633 nm as told; 1 of 150000 values not measured, "
            "passed over");
  EXPECT_TRUE(says(foreign_refusal(folder / "x"), {"x: does not say the wavelength of its values"}));
}

// Of f_ij and f11, taken for independent; of every second element f11 alone is uncertain.
TEST(Netcdf, GivesElementsOverF11TheUncertaintiesOfBoth) {
  const Folder folder;
  std::vector<Variable> variables =
      grid(prepare(random_model(Family::isotropic, {5, 4}, 0, 4), 0.532), Frame::xy, "germer2017");
  Variable u = variables.back();
  u.name = "uncertainty";
  for (std::size_t n = 0; n < u.values.size(); ++n) u.values[n] = n % 16 == 0 ? 0.02 : n % 2 == 0 ? 0.01 : 0;
  variables.push_back(u);
  write(folder / "x", grid_axes, variables, 0);
  for (const Sample& s : read_foreign_file(folder / "x").samples) {
    EXPECT_EQ(s.uncertainty(0, 0), 0.02);
    for (std::size_t e = 1; e < 16; ++e) {
      const double of_element = e % 2 == 0 ? 0.01 / s.f11 : 0, of_f11 = s.normalized.elements[e] * 0.02 / s.f11;
      EXPECT_NEAR(s.uncertainty.elements[e], std::hypot(of_element, of_f11), 1e-15);
    }
  }
}

TEST(Netcdf, IsRefusedInOneLineIfItIsCutOffOrWrong) {
  const Folder folder;
  const std::string path = folder / "x";
  const PreparedModel model = prepare(random_model(Family::isotropic, {2, 2}, 0, 4), 0.532);
  for (const int format : {NC_NETCDF4, 0}) {
    write(path, grid_axes, grid(model, Frame::xy, "germer2017"), format);
    expect_refused_where_cut(path);
  }
  EXPECT_TRUE(says(foreign_refusal(path, {0.5}), {"x: says its wavelengths itself"}));
  const auto refusal = [&](const std::function<void(std::vector<Variable>&)>& change) {
    std::vector<Variable> variables = grid(model, Frame::xy, "germer2017");
    change(variables);
    write(path, grid_axes, variables, 0);
    return foreign_refusal(path);
  };
  EXPECT_TRUE(says(refusal([](auto& v) { v[5].attributes.erase("frame"); }), {"brdf: no attribute frame"}));
  EXPECT_TRUE(says(refusal([](auto& v) { v[5].attributes["frame"] = "lab"; }), {"brdf: frame 'lab' is not one of xy"}));
  EXPECT_TRUE(says(refusal([](auto& v) { v[5].attributes["units"] = "percent"; }), {"units 'percent' are none of"}));
  EXPECT_TRUE(
      says(refusal([](auto& v) { v[0].attributes["units"] = "rad"; }), {"theta_i_deg: units 'rad' contradict"}));
  EXPECT_TRUE(says(refusal([](auto& v) { v[5].name = "f"; }), {"x: no variable brdf"}));
  EXPECT_TRUE(says(refusal([](auto& v) { v[1].name = "theta"; }), {"x: no variable theta_r_deg"}));
  EXPECT_TRUE(says(refusal([](auto& v) { v[0].values[0] = 95; }), {"x: ", "95"}));
  EXPECT_TRUE(says(refusal([](auto& v) { v[0].values[0] = HUGE_VAL; }), {"theta_i_deg: a value is missing"}));
  EXPECT_TRUE(says(refusal([](auto& v) { v[5].values[0] = HUGE_VAL; }), {"brdf: an element is infinite"}));
  EXPECT_TRUE(says(refusal([](auto& v) { v[4].values[0] = 0.5; }), {"wavelength_nm: 0.5 nm is no wavelength"}));
  EXPECT_TRUE(says(refusal([](auto& v) {
                     v[5].axes = {"row", "column", "theta_i_deg"};
                     v[5].values.resize(48);
                   }),
                   {"the last two axes must be row, column"}));
  EXPECT_TRUE(says(refusal([](auto& v) { v[5].attributes.erase("convention"); }), {"brdf: no attribute convention"}));
  EXPECT_TRUE(says(refusal([](auto& v) { v[5].attributes["convention"] = "mine: other"; }), {"brdf: ", "'mine'"}));
  EXPECT_TRUE(says(refusal([](auto& v) { v[4].attributes["units"] = "um"; }),
                   {"wavelength_nm: units 'um' contradict the name"}));
  EXPECT_TRUE(says(refusal([](auto& v) { v[2].name = "phi"; }), {"x: no variable phi_r_deg"}));
  EXPECT_TRUE(says(refusal([](auto& v) { v[0].name = "theta"; }), {"x: no variable theta_i_deg"}));
  const auto with_uncertainty = [&](const std::vector<std::string>& axes, double value) {
    return refusal([&](std::vector<Variable>& v) {
      Variable u = v[5];
      u.name = "uncertainty";
      u.axes = axes;
      u.values.assign(axes.empty() ? 1 : u.values.size(), value);
      v.push_back(u);
    });
  };
  EXPECT_TRUE(says(with_uncertainty({}, 0.1), {"variable uncertainty: its axes are not those of brdf"}));
  EXPECT_TRUE(says(with_uncertainty(grid(model, Frame::xy, "germer2017")[5].axes, -0.25),
                   {"variable uncertainty: -0.25 is none"}));
  EXPECT_TRUE(says(with_uncertainty(grid(model, Frame::xy, "germer2017")[5].axes, HUGE_VAL),
                   {"variable uncertainty: inf is none"}));
  std::map<std::string, std::size_t> wide = grid_axes;
  wide["column"] = 3;
  std::vector<Variable> narrower = grid(model, Frame::xy, "germer2017");
  narrower[5].values.resize(48 * 12);
  write(path, wide, narrower, 0);
  EXPECT_TRUE(says(foreign_refusal(path), {"variable brdf: row and column must be of length 4"}));
  wide = grid_axes;
  wide["other"] = 3;
  std::vector<Variable> elsewhere = grid(model, Frame::xy, "germer2017");
  elsewhere[0].axes = {"other"};
  write(path, wide, elsewhere, 0);
  EXPECT_TRUE(says(foreign_refusal(path), {"variable theta_i_deg: axis other is none of brdf"}));
  wide = grid_axes;
  wide["theta_i_deg"] = NC_UNLIMITED;
  std::vector<Variable> none = grid(model, Frame::xy, "germer2017");
  none[0].values.clear();
  none[5].values.clear();
  write(path, wide, none, 0);
  EXPECT_TRUE(says(foreign_refusal(path), {"variable brdf: axis theta_i_deg is empty"}));
  write(path, {{"sample", std::size_t(1) << 40}}, {{"brdf", {"sample"}, {}, {{"units", "1/sr"}}}}, NC_NETCDF4);
  EXPECT_TRUE(says(foreign_refusal(path, {0.5}), {"numbers are more than a file of"}));
}

/// f11 of four samples in another type, of which the last ones stand for no value.
std::vector<Sample> typed(const Folder& folder, nc_type type, const std::vector<double>& values,
                          const std::vector<double>& missing) {
  int file = 0, axis = 0;
  EXPECT_EQ(nc_create((folder / "x").c_str(), NC_CLOBBER | NC_NETCDF4, &file), NC_NOERR);
  nc_def_dim(file, "sample", values.size(), &axis);
  std::map<std::string, int> ids;
  for (const std::string name : {"theta_i_deg", "theta_r_deg", "phi_r_deg"})
    nc_def_var(file, name.c_str(), NC_DOUBLE, 0, nullptr, &ids[name]);
  nc_def_var(file, "brdf", type, 1, &axis, &ids["brdf"]);
  nc_put_att_text(file, ids["brdf"], "units", 4, "sr-1");
  if (!missing.empty())
    nc_put_att_double(file, ids["brdf"], "missing_value", NC_DOUBLE, missing.size(), missing.data());
  nc_enddef(file);
  const double angle = 30;
  for (const char* name : {"theta_i_deg", "theta_r_deg", "phi_r_deg"}) nc_put_var_double(file, ids[name], &angle);
  EXPECT_EQ(nc_put_var_double(file, ids["brdf"], values.data()), NC_NOERR);
  EXPECT_EQ(nc_close(file), NC_NOERR);
  return read_foreign_file(folder / "x", {0.5}).samples;
}

TEST(Netcdf, TakesMissingValuesAndDefaultFillsOfItsTypeForNoValues) {
  const Folder folder;
  EXPECT_EQ(typed(folder, NC_DOUBLE, {1, 2, -9999, -8888}, {-9999, -8888}).size(), 2U);
  EXPECT_EQ(typed(folder, NC_FLOAT, {1, 2, 1e20, 3}, {1e20}).size(), 3U);
  EXPECT_EQ(typed(folder, NC_SHORT, {1, 2, 3, NC_FILL_SHORT}, {}).size(), 3U);
  EXPECT_EQ(typed(folder, NC_INT, {1, 2, -1, NC_FILL_INT}, {-1}).size(), 2U);
  EXPECT_EQ(typed(folder, NC_UINT, {1, 2, 3, NC_FILL_UINT}, {}).size(), 3U);
  EXPECT_EQ(typed(folder, NC_UBYTE, {1, 2, 3, NC_FILL_UBYTE}, {}).size(), 4U);
}

/// What a variable brdf of this type is refused for, after what is done to it while it is defined.
std::string refused_variable(const Folder& folder, nc_type type, const std::function<void(int file, int id)>& change) {
  int file = 0, axis = 0, id = 0;
  EXPECT_EQ(nc_create((folder / "x").c_str(), NC_CLOBBER | NC_NETCDF4, &file), NC_NOERR);
  nc_def_dim(file, "sample", 2, &axis);
  nc_def_var(file, "brdf", type, 1, &axis, &id);
  change(file, id);
  EXPECT_EQ(nc_close(file), NC_NOERR);
  return foreign_refusal(folder / "x", {0.5});
}

TEST(Netcdf, IsRefusedIfAVariableHoldsTextOrPackedNumbersOrHasNumbersForTexts) {
  const Folder folder;
  const auto nothing = [](int, int) {};
  EXPECT_TRUE(says(refused_variable(folder, NC_CHAR, nothing), {"x: variable brdf: holds no numbers"}));
  EXPECT_TRUE(says(refused_variable(folder, NC_STRING, nothing), {"x: variable brdf: holds no numbers"}));
  for (const std::string packed : {"scale_factor", "add_offset"}) {
    const double factor = 2;
    EXPECT_TRUE(says(
        refused_variable(folder, NC_SHORT,
                         [&](int file, int id) { nc_put_att_double(file, id, packed.c_str(), NC_DOUBLE, 1, &factor); }),
        {"x: variable brdf: " + packed + ": packed numbers cannot be read; write them unpacked"}));
  }
  const double number = 1;
  EXPECT_TRUE(
      says(refused_variable(folder, NC_DOUBLE,
                            [&](int file, int id) { nc_put_att_double(file, id, "units", NC_DOUBLE, 1, &number); }),
           {"x: variable brdf: attribute units is no text"}));
  const std::vector<double> many(1001, 1.0);
  EXPECT_TRUE(says(refused_variable(folder, NC_DOUBLE,
                                    [&](int file, int id) {
                                      nc_put_att_double(file, id, "missing_value", NC_DOUBLE, many.size(), many.data());
                                    }),
                   {"x: variable brdf: missing_value has 1001 values"}));
}

TEST(Netcdf, TakesAnAttributeOfTheNewTypeOfTextsToo) {
  const Folder folder;
  for (const auto& [unit, message] : {std::pair{"sr-1", "no variable theta_i_deg"}, {"lx", "units 'lx' are none of"}})
    EXPECT_TRUE(says(refused_variable(folder, NC_DOUBLE,
                                      [unit = unit](int file, int id) {
                                        const char* text = unit;
                                        nc_put_att_string(file, id, "units", 1, &text);
                                      }),
                     {message}));
}

/// A classic header of these parts: numbers are of four bytes, the highest first.
std::string big(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(value >> shift & 0xffU));
  return bytes;
}
std::string entries(std::uint32_t tag, std::uint32_t count) { return big(tag) + big(count); }
std::string called(const std::string& name) {
  return big(static_cast<std::uint32_t>(name.size())) + name + std::string((4 - name.size() % 4) % 4, '\0');
}

TEST(Netcdf, SaysWhatIsWrongInAClassicHeader) {
  const Folder folder;
  const auto refusal = [&](const std::string& behind_the_records) {
    put(folder / "x", std::string("CDF\1", 4) + big(0) + behind_the_records);
    return foreign_refusal(folder / "x");
  };
  const std::string no_attributes = entries(0, 0), two = entries(10, 2) + called("a") + big(0) + called("b") + big(4);
  const std::string variables = two + no_attributes + entries(11, 1) + called("v");
  constexpr std::uint32_t doubles = 6;
  for (const auto& [header, message] :
       {std::pair{entries(12, 1), "tag 12 in place of 10, a list of dimensions"},
        {entries(0, 1), "tag 0 in place of 10, a list of dimensions"},
        {entries(10, 1025), "1025 dimensions, must be at most 1024"},
        {entries(10, 1) + big(0), "the name of a dimension has 0 bytes, must be 1 to 256"},
        {entries(10, 1) + big(257), "the name of a dimension has 257 bytes, must be 1 to 256"},
        {entries(10, 1) + called("\x1b"), "the name of a dimension is none"},
        {entries(10, 1) + called("\x7f"), "the name of a dimension is none"},
        {entries(10, 1) + big(100), "at offset 20 100 more bytes do not fit into a file of 20"},
        {entries(10, 2) + called("a") + big(0) + called("b") + big(0), "dimension b is a second one without a length"},
        {two + entries(12, 8193), "8193 attributes, must be at most 8192"},
        {two + entries(12, 1) + called("t") + big(7), "attribute t has the type 7"},
        {two + entries(12, 1) + called("t") + big(0), "attribute t has the type 0"},
        {two + entries(12, 1) + called("t") + big(doubles) + big(1 << 22), "attribute t has 33554432 bytes"},
        {two + no_attributes + entries(10, 1), "tag 10 in place of 11, a list of variables"},
        {variables + big(1025), "variable v has 1025 dimensions"},
        {variables + big(1) + big(2), "variable v has the dimension 2, which is not there"},
        {variables + big(2) + big(1) + big(0), "variable v has its records behind another dimension"},
        {variables + big(1) + big(1) + no_attributes + big(doubles) + big(32) + big(200) + std::string(100, '\0'),
         "variable v goes from byte 200 to 232 of a file of 192"},
        {variables + big(1) + big(1) + no_attributes + big(doubles) + big(32) + big(91) + std::string(100, '\0'),
         "variable v goes from byte 91 to 123 of a file of 192"}})
    EXPECT_TRUE(says(refusal(header), {"x: NetCDF header: " + std::string(message) + "; damaged or cut off?"}));
}

/// Of a record dimension too: where the library's own reader took gigabytes, or crashed.
TEST(Netcdf, IsReadOrRefusedInOneLineWhateverByteOfAClassicHeaderIsWrong) {
  const Folder folder;
  const std::string path = folder / "x";
  const PreparedModel model = prepare(random_model(Family::isotropic, {2, 2}, 0, 4), 0.532);
  for (const auto& [format, records] :
       {std::pair{0, std::size_t(3)}, {NC_64BIT_OFFSET, std::size_t(3)}, {NC_64BIT_DATA, std::size_t(NC_UNLIMITED)}}) {
    std::map<std::string, std::size_t> axes = grid_axes;
    axes["theta_i_deg"] = records;
    std::vector<Variable> variables = grid(model, Frame::xy, "germer2017");
    write(path, axes, variables, format);
    const std::string whole = contents(path);
    const std::size_t header = whole.size() - 3 * 4 * 4 * 16 * 8;
    for (std::size_t at = 0; at < header; ++at) {
      std::string wrong = whole;
      wrong[at] = '\x7f';
      put(path, wrong);
      try {
        read_foreign_file(path);
      } catch (const std::runtime_error& refusal) {
        const std::string message = refusal.what();
        EXPECT_TRUE(message.starts_with(path)) << at << ' ' << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << at;
      }
    }
  }
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  EXPECT_LT(used.ru_maxrss, 1000000L);  // kB; with sanitizers, too
}
#endif

}  // namespace
}  // namespace mmbrdf
