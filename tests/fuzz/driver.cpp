// Runs a fuzz target without libFuzzer: every file named, then mutations of them by a seeded
// generator. Compiled with -fsanitize-coverage=trace-pc, what reaches new code is mutated further.
#include <algorithm>
#include <ctime>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Input = std::vector<std::uint8_t>;

constexpr std::size_t kLongest = 4096;
constexpr std::size_t kEdges = 1 << 16;

std::uint8_t hit[kEdges];
std::uint8_t known[kEdges];
std::uint64_t previous = 0;
Input current; // for those who look at it after a crash

// Whether this run went where none went before.
bool is_new() {
    bool found = false;
    for (std::size_t k = 0; k < kEdges; ++k) {
        // One, two, few or many times.
        const std::uint8_t times = hit[k] < 3 ? hit[k] : hit[k] < 16 ? 4 : 8;
        found = found || (times & ~known[k]) != 0;
        known[k] = static_cast<std::uint8_t>(known[k] | times);
    }
    return found;
}

bool run(const Input& input) {
    std::memset(hit, 0, sizeof hit);
    previous = 0;
    current = input;
    LLVMFuzzerTestOneInput(current.data(), current.size());
    return is_new();
}

void keep_crash(int signal) {
    if (std::FILE* file = std::fopen("crash.bin", "wb")) {
        std::fwrite(current.data(), 1, current.size(), file);
        std::fclose(file);
        std::fputs("the input is in crash.bin\n", stderr);
    }
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

class Mutator {
  public:
    explicit Mutator(std::uint64_t seed) : random_(seed) {}

    std::size_t below(std::size_t limit) { return random_() % limit; }

    Input mutate(Input input, const Input& other) {
        for (std::size_t k = 1 + below(4); k > 0; --k) {
            change(input, other);
        }
        input.resize(std::min(input.size(), kLongest));
        return input;
    }

  private:
    void change(Input& input, const Input& other) {
        if (input.empty()) {
            input.push_back(static_cast<std::uint8_t>(random_()));
        }
        const std::size_t at = below(input.size());
        switch (below(7)) {
        case 0:
            input[at] ^= static_cast<std::uint8_t>(1U << below(8));
            break;
        case 1:
            input[at] = static_cast<std::uint8_t>(random_());
            break;
        case 2: { // numbers that break readers
            static constexpr std::uint64_t kSpecial[] = {
                0, 1, 0x7f, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0xffffffff, 0x7ff0000000000000,
                0x7ff8000000000000, 0x7fefffffffffffff, 0x0010000000000000, 0x3ff0000000000000};
            const std::uint64_t value = kSpecial[below(std::size(kSpecial))];
            const std::size_t width = std::min<std::size_t>(1 << below(4), input.size() - at);
            std::memcpy(&input[at], &value, width);
            break;
        }
        case 3: // cut
            input.erase(input.begin() + static_cast<std::ptrdiff_t>(at),
                        input.begin() + static_cast<std::ptrdiff_t>(
                                            std::min(at + 1 + below(16), input.size())));
            break;
        case 4: // bytes copied from one place to another
            for (std::size_t k = 0, from = below(input.size()), count = 1 + below(24);
                 k < count && at + k < input.size() && from + k < input.size(); ++k) {
                input[at + k] = input[from + k];
            }
            break;
        case 5: // the end of another
            if (!other.empty()) {
                input.resize(at);
                input.insert(input.end(),
                             other.begin() + static_cast<std::ptrdiff_t>(
                                                 std::min(at, other.size() - 1)),
                             other.end());
            }
            break;
        default:
            input.insert(input.begin() + static_cast<std::ptrdiff_t>(at), 1 + below(8),
                         static_cast<std::uint8_t>(random_()));
        }
    }

    std::mt19937_64 random_;
};

void add_files(std::vector<Input>& corpus, const std::string& name) {
    std::vector<std::filesystem::path> paths;
    if (std::filesystem::is_directory(name)) {
        for (const auto& entry : std::filesystem::directory_iterator(name)) {
            paths.push_back(entry.path());
        }
    } else {
        paths.emplace_back(name);
    }
    std::sort(paths.begin(), paths.end());
    for (const auto& path : paths) {
        std::ifstream file(path, std::ios::binary);
        if (!file) {
            std::fprintf(stderr, "%s cannot be read\n", path.c_str());
            std::exit(2);
        }
        corpus.emplace_back(std::istreambuf_iterator<char>(file),
                            std::istreambuf_iterator<char>());
    }
}

} // namespace

// Called by compiled code on every edge.
extern "C" void __sanitizer_cov_trace_pc() {
    const auto place = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
    std::uint8_t& count = hit[(place * 0x9E3779B97F4A7C15U ^ previous) >> 48];
    count = static_cast<std::uint8_t>(count + (count < 255 ? 1 : 0));
    previous = (place * 0x9E3779B97F4A7C15U) >> 1;
}

int main(int argc, char** argv) {
    std::uint64_t runs = 0, seed = 0;
    double seconds = 0;
    std::vector<Input> corpus;
    for (int k = 1; k < argc; ++k) {
        const std::string word = argv[k];
        if (word.starts_with("-runs=")) {
            runs = std::stoull(word.substr(6));
        } else if (word.starts_with("-seconds=")) {
            seconds = std::stod(word.substr(9));
        } else if (word.starts_with("-seed=")) {
            seed = std::stoull(word.substr(6));
        } else {
            add_files(corpus, word);
        }
    }
    std::signal(SIGABRT, keep_crash);
    std::signal(SIGSEGV, keep_crash);
    const std::size_t seeds = corpus.size();
    for (const Input& input : corpus) {
        run(input);
    }
    Mutator mutator(seed);
    corpus.emplace_back();
    const std::clock_t began = std::clock();
    std::uint64_t done = 0;
    const auto goes_on = [&] {
        return done < runs ||
               static_cast<double>(std::clock() - began) < seconds * CLOCKS_PER_SEC;
    };
    for (; goes_on(); ++done) {
        const Input& input = corpus[mutator.below(corpus.size())];
        const Input mutated = mutator.mutate(input, corpus[mutator.below(corpus.size())]);
        if (run(mutated)) {
            corpus.push_back(mutated);
        }
    }
    const auto edges = std::count_if(std::begin(known), std::end(known), [](auto k) { return k; });
    std::printf("%zu files replayed, %llu mutations in %.1f CPU seconds, %zu kept, %td edges\n",
                seeds, static_cast<unsigned long long>(done),
                static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC,
                corpus.size() - 1 - seeds, edges);
    return 0;
}
