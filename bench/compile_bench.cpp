// What a user's translation unit costs: CPU time and peak memory of the compiler, against the budgets and against what
// Eigen and Boost.Geometry cost in the same run.

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace {

namespace fs = std::filesystem;

struct Cost {
  double user_s{}, memory_mb{};
};

/// Times in those of Eigen/Dense with the same flags, which hardly depend on the machine.
struct Budget {
  double at_o0{}, at_o2{}, memory_mb{};
};

struct Unit {
  std::string name, text, definitions{};
  std::optional<Budget> budget{};
};

struct Row {
  std::string name, flags;
  Cost cost;
  double of_eigen{}, of_boost{};  ///< the time in those of the references
  std::optional<double> budget{}, budget_mb{};

  [[nodiscard]] bool kept() const {
    return !(budget && of_eigen > *budget) && !(budget_mb && cost.memory_mb > *budget_mb);
  }
};

/// A folder of one's own, removed in the end.
class Workplace {
 public:
  Workplace() {
    std::string pattern = (fs::temp_directory_path() / "cambium_compile_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder " + pattern);
    folder = pattern;
  }
  Workplace(Workplace const&) = delete;
  Workplace& operator=(Workplace const&) = delete;
  ~Workplace() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }

  fs::path folder;
};

std::string text_of(fs::path const& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Program number `number`, from 1 on, of those in a README that run.
std::string program_of(fs::path const& readme, int number) {
  auto const text = text_of(readme);
  std::size_t at = 0;
  for (int i = 0; i < number; ++i) {
    at = text.find("<!-- runs", at);
    if (at == text.npos) throw std::runtime_error(readme.string() + " has no program " + std::to_string(number));
    at += 1;
  }
  auto const begin = text.find("```cpp\n", at) + 7;
  return text.substr(begin, text.find("```", begin) - begin);
}

class Compiler {
 public:
  Compiler(std::string command, std::string flags_file) : command_(std::move(command)), flags_(std::move(flags_file)) {}

  /// What it costs to compile `text`, the least of some times. Throws with the first error where it does not compile.
  [[nodiscard]] Cost measure(std::string const& text, std::vector<std::string> const& options, int times) const {
    auto const source = place_.folder / "unit.cpp", log = place_.folder / "log";
    std::ofstream(source) << text << '\n';
    std::vector<std::string> words{command_, "@" + flags_, "-c", "-o", (place_.folder / "unit.o").string()};
    words.insert(words.end(), options.begin(), options.end());
    words.push_back(source.string());
    Cost least{1e9, 1e9};
    for (int i = 0; i < times; ++i) {
      auto const cost = run(words, log);
      least = {std::min(least.user_s, cost.user_s), std::min(least.memory_mb, cost.memory_mb)};
    }
    return least;
  }

 private:
  [[nodiscard]] static Cost run(std::vector<std::string> words, fs::path const& log) {
    std::vector<char*> arguments;
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::fflush(stdout);
    pid_t const child = fork();
    if (child < 0) throw std::runtime_error("cannot start " + words[0]);
    if (child == 0) {
      if (std::freopen(log.c_str(), "w", stdout) != nullptr && dup2(1, 2) >= 0) execvp(arguments[0], arguments.data());
      _exit(127);
    }
    int status = 0;
    rusage usage{};
    if (wait4(child, &status, 0, &usage) < 0) throw std::runtime_error("cannot wait for " + words[0]);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
      std::ifstream lines(log);
      std::string line;
      while (std::getline(lines, line) && line.find("error") == line.npos) {
      }
      throw std::runtime_error("does not compile: " + line);
    }
    return {static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec),
            static_cast<double>(usage.ru_maxrss) / 1024.0};
  }

  std::string command_, flags_;
  Workplace place_;
};

std::string including(std::string const& header) { return "#include <" + header + ">"; }

std::vector<Unit> units(fs::path const& root) {
  std::vector<Unit> all{{"reference/eigen_dense", including("Eigen/Dense")},
                        {"reference/boost_geometry", including("boost/geometry.hpp")}};
  for (auto const& [header, times] : std::initializer_list<std::pair<char const*, double>>{
           {"geometry.hpp", 1.5}, {"map.hpp", 3.0}, {"world.hpp", 3.5}, {"planner.hpp", 5.0}, {"cambium.hpp", 6.5}})
    all.push_back({"include/" + std::string(header),
                   including("cambium/" + std::string(header)),
                   {},
                   Budget{times, times, 400.0}});
  auto const first = program_of(root / "README.md", 1);
  auto const planner = program_of(root / "include/cambium/planner/README.md", 1);
  std::string const compiled = "-DCAMBIUM_COMPILED";
  all.push_back(
      {"include/predictor.hpp/compiled", including("cambium/predictor.hpp"), compiled, Budget{1.0, 1.0, 200.0}});
  all.push_back({"stack/compiled", program_of(root / "README.md", 2), compiled, Budget{1.0, 1.0, 200.0}});
  all.push_back({"planner/compiled", planner, compiled, Budget{8.5, 14.0, 600.0}});
  all.push_back({"first/compiled", first, compiled, Budget{8.5, 11.5, 600.0}});
  all.push_back({"benchmark/compiled", program_of(root / "include/cambium/benchmark/README.md", 1), compiled,
                 Budget{20.0, 28.0, 1000.0}});
  all.push_back({"first/header_only", first, {}, Budget{23.0, 36.0, 1200.0}});
  // A world declared extern, by who uses it, and by who instantiates it.
  auto const parts = program_of(root / "include/cambium/world/README.md", 2);
  auto const instantiation = parts.find("// my_world.cpp"), use = parts.find("// any other source");
  if (instantiation == parts.npos || use == parts.npos)
    throw std::runtime_error("world/README.md: the second program lacks its comments that divide it into sources");
  all.push_back({"extern/use", parts.substr(0, instantiation) + parts.substr(use), compiled, Budget{8.5, 8.5, 600.0}});
  all.push_back({"extern/instantiate", parts.substr(0, use), compiled});
  all.push_back(
      {"planners/compiled", text_of(root / "bench/compile_planners.cpp"), compiled, Budget{17.0, 31.0, 1000.0}});
  return all;
}

void print(Row const& row) {
  std::printf("%-26s %s %8.2f s %6.0f MB %7.1f %7.1f", row.name.c_str(), row.flags.c_str(), row.cost.user_s,
              row.cost.memory_mb, row.of_eigen, row.of_boost);
  if (row.budget)
    std::printf("   budget %4.1f %5.0f MB   %s", *row.budget, *row.budget_mb, row.kept() ? "kept" : "MISSED");
  std::printf("\n");
  std::fflush(stdout);
}

void write_json(fs::path const& file, std::vector<Row> const& rows) {
  std::ofstream out(file);
  out << "[";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto const& row = rows[i];
    auto const number = [](std::optional<double> const& value) {
      std::ostringstream text;
      if (value) text << *value;
      return value ? text.str() : std::string("null");
    };
    out << (i == 0 ? "\n" : ",\n") << "  {\"name\": \"" << row.name << "\", \"flags\": \"" << row.flags
        << "\", \"user_s\": " << row.cost.user_s << ", \"memory_mb\": " << row.cost.memory_mb
        << ", \"of_eigen\": " << row.of_eigen << ", \"budget\": " << number(row.budget)
        << ", \"budget_mb\": " << number(row.budget_mb)
        << ", \"kept\": " << (row.budget ? (row.kept() ? "true" : "false") : "null") << "}";
  }
  out << "\n]\n";
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

/// What each public header costs to include, costliest first, and the costliest of what it includes itself.
void print_headers(Compiler const& compiler, fs::path const& root) {
  std::vector<std::string> headers;
  for (auto const& entry : fs::recursive_directory_iterator(root / "include")) {
    auto const header = fs::relative(entry.path(), root / "include").string();
    if (entry.path().extension() != ".hpp" || header.find("/detail/") != header.npos || header.ends_with("_impl.hpp"))
      continue;
    headers.push_back(header);
  }
  std::map<std::string, double> known;
  auto const cost_of = [&](std::string const& header) {
    auto const [at, is_new] = known.try_emplace(header, 0.0);
    if (is_new) at->second = compiler.measure(including(header), {"-O0"}, 1).user_s;
    return at->second;
  };
  std::vector<std::pair<double, std::string>> lines;
  for (auto const& header : headers) {
    auto const text = text_of(root / "include" / header);
    std::vector<std::pair<double, std::string>> parts;
    std::regex const include("#include [<\"]([^>\"]+)[>\"]");
    for (std::sregex_iterator at(text.begin(), text.end(), include), end; at != end; ++at) {
      std::string const part = (*at)[1];
      if (!part.ends_with("_impl.hpp")) parts.emplace_back(cost_of(part), part);
    }
    std::sort(parts.rbegin(), parts.rend());
    std::ostringstream line;
    line << std::fixed << std::setprecision(2) << std::left << std::setw(46) << header << cost_of(header) << " s";
    for (std::size_t i = 0; i < parts.size() && i < 3; ++i)
      line << (i == 0 ? "   of which " : ", ") << parts[i].second << " " << parts[i].first;
    lines.emplace_back(cost_of(header), line.str());
    std::cerr << "\r" << lines.size() << " of " << headers.size() << " headers" << std::flush;
  }
  std::cerr << "\r";
  std::sort(lines.rbegin(), lines.rend());
  for (auto const& [cost, line] : lines) std::cout << line << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What a translation unit that includes cambium costs to compile, against the budgets");
  std::string json, filter = ".*", command = "g++";
  int repetitions = 2;
  bool all_headers = false;
  app.add_option("--json", json, "write the rows to this file");
  app.add_option("--filter", filter, "only the units whose names match this regular expression");
  app.add_option("--repetitions", repetitions, "of which the least counts")->check(CLI::Range(1, 100));
  app.add_option("--compiler", command, "that is measured")->capture_default_str();
  app.add_flag("--headers", all_headers, "what each public header costs, and what of it comes from where");
  CLI11_PARSE(app, argc, argv);
  try {
    fs::path const root(CAMBIUM_SOURCE_DIR);
    Compiler const compiler(command, CAMBIUM_COMPILE_FLAGS);
    if (all_headers) {
      print_headers(compiler, root);
      return 0;
    }
    std::printf(
        "%s, user CPU seconds and peak memory, least of %d %s; ratios to Eigen/Dense and to boost/geometry.hpp\n",
        command.c_str(), repetitions, repetitions == 1 ? "run" : "runs");
    std::regex const chosen(filter);
    std::vector<Row> rows;
    std::map<std::string, Cost> references;
    for (auto const& unit : units(root))
      for (std::string const flags : {"-O0", "-O2"}) {
        bool const is_reference = unit.name.starts_with("reference/");
        if (!is_reference && !std::regex_search(unit.name, chosen)) continue;
        std::vector<std::string> options{flags};
        if (!unit.definitions.empty()) options.push_back(unit.definitions);
        Row row{unit.name, flags, compiler.measure(unit.text, options, repetitions)};
        if (unit.budget) {
          row.budget = flags == "-O0" ? unit.budget->at_o0 : unit.budget->at_o2;
          row.budget_mb = unit.budget->memory_mb;
        }
        if (is_reference) references[unit.name + flags] = row.cost;
        auto const of = [&](char const* name) {
          auto const at = references.find(name + flags);
          return at == references.end() ? 0.0 : row.cost.user_s / at->second.user_s;
        };
        row.of_eigen = of("reference/eigen_dense");
        row.of_boost = of("reference/boost_geometry");
        print(row);
        rows.push_back(row);
      }
    if (!json.empty()) write_json(json, rows);
  } catch (std::exception const& error) {
    std::cerr << "bench/run compile: " << error.what() << "\n";
    return 1;
  }
}
