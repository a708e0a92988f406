// The field example as a user meets it, and its estimators on data whose answer is known. Costs 25 s, all of it 2 min.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "../../examples/field/gaps.hpp"
#include "../support/scale.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "program.hpp"

using namespace program;

TEST_CASE("the field example measures the wave in a jam, and writes the same rows in every run") {
  Program const program("field");
  browser::TemporaryFolder const folder;
  auto const file = (folder.path() / "rows.json").string(), again = (folder.path() / "again.json").string();
  REQUIRE(program.run({"--only", "queue", "--seed", "3", "--json", file}).err.empty());
  REQUIRE(program.run({"--only", "queue", "--seed", "3", "--json", again, "--threads", "1"}).err.empty());
  auto const text = content_of(file);
  CHECK(text == content_of(again));
  auto const rows = nlohmann::json::parse(text).at("rows");
  REQUIRE(rows.size() == 1);
  for (auto const* const key : {"quantity", "people", "cambium", "sumo", "unit", "source"})
    CHECK(rows[0].contains(key));
  CHECK(rows[0]["cambium"].get<double>() < -15.0);
  CHECK(rows[0]["cambium"].get<double>() > -22.0);
}

// Each row has its source, see examples/field. The drivers were tuned with other seeds. A row that people's traffic
// does not share with ours yet is named here, with how far it may be off.
TEST_CASE("traffic stays in people's bands, but for the rows named here") {
  struct Miss {
    char const* quantity;
    double low, high;
  };
  constexpr Miss misses[] = {
      {"speed at 1500 cars an hour", 100, 115},
      {"density at capacity", 22, 31},
      {"change of that mean from 900 to 2000 cars an hour", 0.0, 0.25},
      {"speed in shares of the limit, mean", 0.97, 1.07},
      {"speed of cars without a limit, mean", 110, 125},
      {"of these above 130 km/h", 0.15, 0.35},
      {"capacity drop at a lane drop", 0.0, 0.2},
      {"wave of those who start in a jam", -22, -15},
      {"correlation time of that noise", 0.7, 2.0},
      {"of these below 1 s", 0.02, 0.1},
      {"saturation flow of a lane at green", 1730, 1950},
      {"red running on a busy approach, an hour", 0.15, 2.0},
      {"red running on a busy approach, a cycle", 0.004, 0.042},
      {"two-way stop, left from major: capacity in shares of people's", 0.75, 1.15},
      {"two-way stop, left from major: the share farthest off", 0.65, 1.3},
      {"two-way stop, right from minor: capacity in shares of people's", 0.8, 1.15},
      {"two-way stop, right from minor: the share farthest off", 0.7, 1.3},
      {"two-way stop, through from minor: the share farthest off", 0.75, 1.3},
      {"two-way stop, left from minor: the share farthest off", 0.75, 1.35},
      {"follow-up headway, left from major", 1.9, 2.9},
      {"follow-up headway, right from minor", 3.0, 4.0},
      {"follow-up headway, through from minor", 3.6, 4.3},
      {"critical gap, right from minor", 5.7, 6.9},
      {"critical gap, left from minor", 6.1, 7.6},
      {"roundabout entry, 1000 cars an hour in the ring", 230, 557},
      {"all-way stop, headway with a queue opposite", 3.6, 5.2},
      {"all-way stop, headway with queues on two other arms", 5.9, 7.5},
      {"all-way stop, headway with queues on all arms", 6.3, 10.6},
  };
  Program const program("field");
  if (!program.is_there()) return;
  browser::TemporaryFolder const folder;
  auto const file = folder.file("rows.json");
  std::vector<std::string> experiments{"yellow", "stop braking", "turns", "saturation", "following", "patience"};
  if (support::runs(10) >= 10)
    for (auto const* const slow : {"segment", "trucks", "no limit", "lane drop", "queue", "noise", "red running",
                                   "two-way stop", "roundabout", "all-way stop", "junctions with trucks"})
      experiments.emplace_back(slow);
  for (auto const& name : experiments) {
    REQUIRE(program.run({"--seed", "7", "--only", name, "--json", file}).err.empty());
    auto const rows = nlohmann::json::parse(content_of(file)).at("rows");
    CHECK(!rows.empty());
    for (auto const& row : rows) {
      auto const quantity = row["quantity"].get<std::string>();
      double low = row["people"].front().get<double>(), high = row["people"].back().get<double>();
      for (auto const& miss : misses)
        if (quantity == miss.quantity) low = miss.low, high = miss.high;
      CAPTURE(quantity);
      double const value = row["cambium"].get<double>();
      CHECK(value >= low);
      CHECK(value <= high);
    }
  }
}

TEST_CASE("critical gaps, capacity and logistic regression come out as they were put in") {
  cambium::RandomStream random(7, 0, 0);
  for (double const mean : {4.1, 7.1})
    for (double const flow : {300.0, 900.0}) {
      CAPTURE(mean);
      CAPTURE(flow);
      constexpr double sigma = 0.2, follow_up = 3.3;
      double const mu = std::log(mean) - 0.5 * sigma * sigma;
      auto const gap = [&] { return cambium::Exponential{flow / 3600.0}(random); };
      std::vector<field::Decision> all;
      for (int driver = 0; driver < 3000; ++driver) {
        double const critical = std::exp(mu + sigma * cambium::Normal{}(random));
        field::Decision decision;
        while ((decision.accepted = gap()) < critical)
          decision.rejected = std::max(decision.rejected, decision.accepted);
        all.push_back(decision);
      }
      CHECK(field::critical_gap(all) == doctest::Approx(mean).epsilon(0.03));
      double time = 0.0, entered = 0.0;
      while (time < 1e6) {
        double const length = gap();
        time += length;
        if (length >= mean) entered += 1.0 + std::floor((length - mean) / follow_up);
      }
      CHECK(field::gap_capacity(flow, mean, follow_up) == doctest::Approx(entered * 3600.0 / time).epsilon(0.02));
    }
  CHECK(field::gap_capacity(0.0, 5.0, 2.5) == 1440.0);
  std::vector<double> x;
  std::vector<bool> stopped;
  for (int i = 0; i < 5000; ++i) {
    x.push_back(8.0 * cambium::uniform01(random));
    stopped.push_back(cambium::uniform01(random) < 1.0 / (1.0 + std::exp(-2.0 * (x.back() - 3.0))));
  }
  field::Logistic const stops(x, stopped);
  CHECK(stops.at(0.5) == doctest::Approx(3.0).epsilon(0.03));
  CHECK(stops.at(0.9) == doctest::Approx(3.0 + std::log(9.0) / 2.0).epsilon(0.04));
  CHECK(field::quantile({3.0, 1.0, 2.0}, 0.5) == 2.0);
  CHECK(field::quantile({3.0, 1.0, 2.0}, 0.75) == 2.5);
  CHECK(std::isnan(field::quantile({}, 0.5)));
}

TEST_CASE("the field example names the fault in its options") {
  Program const program("field");
  for (auto const& words : {std::vector<std::string>{"--only", "nothing"}, {"--threads", "0"}, {"--seed", "x"}})
    program.refuses(words, words[0]);
}
