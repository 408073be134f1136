// SPDX-License-Identifier: BSD-3-Clause
#include "files/posterior_json.hpp"

#include <algorithm>
#include <cstdint>

#include "text/base64.hpp"

namespace mmbrdf {
namespace {

using nlohmann::ordered_json;

template <class Number>
std::string packed(const std::vector<Number>& numbers) {
  return numbers_to_base64(std::span<const Number>(numbers));
}

template <class Number>
std::vector<Number> unpacked(const Field& field) {
  auto numbers = numbers_from_base64<Number>(field.text());
  if (!numbers) field.refuse("must be numbers of " + std::to_string(8 * sizeof(Number)) + " bits in base 64");
  return std::move(*numbers);
}

constexpr int offset = 2048;  // of the twelve bits of a number

/// Two numbers in three bytes.
std::string packed_12_bits(const std::vector<std::int16_t>& numbers) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    const auto a = static_cast<unsigned>(numbers[i] + offset),
               b = i + 1 < numbers.size() ? static_cast<unsigned>(numbers[i + 1] + offset) : 0;
    for (const unsigned byte : {a & 255, a >> 8 | (b & 15) << 4, b >> 4})
      bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  return to_base64(bytes);
}

std::vector<std::int16_t> unpacked_12_bits(const Field& field, std::size_t count) {
  const auto bytes = from_base64(field.text());
  if (!bytes || bytes->size() != (count + 1) / 2 * 3)
    field.refuse("must be " + std::to_string(count) + " numbers of 12 bits in base 64");
  std::vector<std::int16_t> result;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* three = bytes->data() + i / 2 * 3;
    const int bits = i % 2 == 0 ? three[0] | (three[1] & 15) << 8 : three[1] >> 4 | three[2] << 4;
    result.push_back(static_cast<std::int16_t>(bits - offset));
  }
  return result;
}

ordered_json readings_json(const std::vector<ReadingDirections>& readings) {
  std::vector<float> angles;
  std::vector<std::uint32_t> counts;
  for (const auto& [four, count] : readings) {
    angles.insert(angles.end(), four.begin(), four.end());
    counts.push_back(count);
  }
  ordered_json result = {{"angles_rad", packed(angles)}};
  if (std::ranges::any_of(counts, [](std::uint32_t count) { return count != 1; })) result["counts"] = packed(counts);
  return result;
}

std::vector<ReadingDirections> read_readings(const Field& field) {
  field.require_no_other_than({"angles_rad", "counts"});
  const std::vector<float> angles = unpacked<float>(field["angles_rad"]);
  std::vector<std::uint32_t> counts(angles.size() / 4, 1);
  if (field.has("counts")) counts = unpacked<std::uint32_t>(field["counts"]);
  if (angles.size() != 4 * counts.size()) field.refuse("must be four angles for each count");
  std::vector<ReadingDirections> result;
  for (std::size_t i = 0; i < counts.size(); ++i)
    result.push_back({{angles[4 * i], angles[4 * i + 1], angles[4 * i + 2], angles[4 * i + 3]}, counts[i]});
  return result;
}

ordered_json block_json(const BlockPosterior& p, const Block& block) {
  ordered_json result = {{"elements", block.name}, {"hyperparameters", ordered_json::object()}};
  const std::vector<std::string> names = hyperparameter_names(block);
  for (std::size_t i = 0; i < names.size(); ++i) result["hyperparameters"][names[i]] = p.hyperparameters[i];
  result["noise_variance"] = p.noise_variance;
  result["evidence"] = p.evidence;
  result["mean"] = packed(p.mean);
  result["free_mean"] = packed(p.free_mean);
  result["shared"] = packed(p.shared);
  if (!p.factor.empty()) {
    result["deviations"] = packed(p.deviations);
    result["factor"] = packed_12_bits(p.factor);
  }
  return result;
}

BlockPosterior read_block(const Field& field, const Block& block) {
  field.require_no_other_than({"elements", "hyperparameters", "noise_variance", "evidence", "mean", "free_mean",
                               "shared", "deviations", "factor"});
  if (field["elements"].text() != block.name) field["elements"].refuse("block " + block.name + " comes here");
  BlockPosterior p;
  for (const std::string& name : hyperparameter_names(block))
    p.hyperparameters.push_back(field["hyperparameters"][name].number());
  p.noise_variance = field["noise_variance"].number();
  p.evidence = field["evidence"].number();
  p.mean = unpacked<double>(field["mean"]);
  p.free_mean = unpacked<float>(field["free_mean"]);
  p.shared = unpacked<float>(field["shared"]);
  if (!field.has("factor")) return p;
  p.deviations = unpacked<float>(field["deviations"]);
  p.factor = unpacked_12_bits(field["factor"], block.modes.size() * (block.modes.size() + 1) / 2);
  return p;
}

ordered_json law_json(const ReadingLaw& law) {
  return {{"incident_exponent", law.incident_exponent},
          {"reflected_exponent", law.reflected_exponent},
          {"relative", law.relative}};
}

ReadingLaw read_law(const Field& field) {
  field.require_no_other_than({"incident_exponent", "reflected_exponent", "relative"});
  return {field["incident_exponent"].number(), field["reflected_exponent"].number(), field["relative"].boolean()};
}

PosteriorAt read_at(const Field& field, const std::vector<Block>& blocks) {
  field.require_no_other_than({"wavelength_um", "law", "f11", "readings", "blocks"});
  PosteriorAt at{field["wavelength_um"].number(), read_law(field["law"]), unpacked<double>(field["f11"]), 0, {}};
  const int readings = field["readings"].integer();
  if (readings < 0) field["readings"].refuse(field["readings"].shown() + " is negative");
  at.readings = static_cast<std::size_t>(readings);
  const std::vector<Field> items = field["blocks"].items();
  require_count(field["blocks"], items.size(), blocks.size(), "one for each block");
  for (std::size_t b = 0; b < blocks.size(); ++b) at.blocks.push_back(read_block(items[b], blocks[b]));
  return at;
}

}  // namespace

ordered_json posterior_json(const Posterior& posterior) {
  const PosteriorData& data = posterior.data();
  ordered_json result = {{"orders", {data.orders.f11, data.orders.other}}};
  for (const auto& [name, size] : data.errors) result["shared_errors"].push_back({{"name", name}, {"size", size}});
  if (data.unread.any()) result["unread"] = elements_json(data.unread);
  result["readings"] = ordered_json::array();
  for (const auto& list : data.readings) result["readings"].push_back(readings_json(list));
  for (const PosteriorAt& at : data.wavelengths) {
    ordered_json one = {{"wavelength_um", at.wavelength},
                        {"law", law_json(at.law)},
                        {"f11", packed(at.f11)},
                        {"readings", at.readings},
                        {"blocks", ordered_json::array()}};
    for (std::size_t b = 0; b < at.blocks.size(); ++b)
      one["blocks"].push_back(block_json(at.blocks[b], posterior.blocks()[b]));
    result["wavelengths"].push_back(std::move(one));
  }
  return result;
}

PosteriorData read_posterior_data(const Field& field, DiscMapping mapping, const Elements& not_measured) {
  field.require_no_other_than({"orders", "shared_errors", "unread", "readings", "wavelengths"});
  const std::vector<Field> orders = field["orders"].items();
  require_count(field["orders"], orders.size(), 2, "of f11 and of the other elements");
  PosteriorData data{{orders[0].integer(), orders[1].integer()}, mapping, not_measured, {}, {}, {}};
  const std::vector<Block> blocks =
      checked(field["orders"], [&] { return without(not_measured, mmbrdf::blocks(Family::isotropic, data.orders)); });
  for (const Field& error : field["shared_errors"].items())
    data.errors.push_back({error["name"].text(), error["size"].number()});
  if (field.has("unread")) data.unread = read_elements(field["unread"]);
  for (const Field& list : field["readings"].items()) data.readings.push_back(read_readings(list));
  for (const Field& at : field["wavelengths"].items()) data.wavelengths.push_back(read_at(at, blocks));
  return data;
}

Posterior read_posterior(const Field& field, DiscMapping mapping, const Elements& not_measured) {
  PosteriorData data = read_posterior_data(field, mapping, not_measured);
  return checked(field, [&] { return Posterior(std::move(data)); });
}

}  // namespace mmbrdf
