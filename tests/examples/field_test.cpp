// The field example as a user meets it, and its estimators on data whose answer is known. Costs 8 s.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "../../examples/field/gaps.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "program.hpp"

using namespace program;

TEST_CASE("the field example measures the wave in a jam as people's, and writes the same rows in every run") {
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
  CHECK(rows[0]["cambium"].get<double>() > -21.0);
}

TEST_CASE("the field example measures stops at lights and stop signs as the drivers' parameters demand") {
  Program const program("field");
  browser::TemporaryFolder const folder;
  auto const file = folder.file("rows.json");
  auto const rows_of = [&](char const* name) {
    REQUIRE(program.run({"--only", name, "--json", file}).err.empty());
    return nlohmann::json::parse(content_of(file)).at("rows");
  };
  auto const yellow = rows_of("yellow");
  REQUIRE(yellow.size() == 5);
  auto const value = [](nlohmann::json const& row) { return row["cambium"].get<double>(); };
  CHECK(value(yellow[1]) > 1.5);  // people's comfortable deceleration: 2 m/s^2
  CHECK(value(yellow[2]) > value(yellow[1]));
  CHECK(value(yellow[3]) < value(yellow[4]));  // the nearer to the line, the fewer stop
  auto const stop = rows_of("stop braking");
  REQUIRE(stop.size() == 2);
  CHECK(value(stop[0]) > 1.5);
  CHECK(value(stop[1]) < 8.0);
  auto const turns = rows_of("turns");
  CHECK(value(turns.at(0)) > 2.0);
  CHECK(value(turns.at(0)) < 4.0);
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
