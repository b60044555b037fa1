#include "picture/drawing_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "protocol/cpp/suggest.hpp"

namespace oval4d::picture {

namespace {

using namespace std::chrono_literals;
using Clock = Patience::Clock;

constexpr const char* kThreadsVariable = "LP_NUM_THREADS=";

/// This program's environment, with so many threads for llvmpipe unless it says how many itself.
class Environment {
  public:
    explicit Environment(int threads) : threads_(kThreadsVariable + std::to_string(threads)) {
        for (char** each = environ; *each != nullptr; ++each) entries_.push_back(*each);
        const auto said = [](const char* entry) { return std::string_view(entry).starts_with(kThreadsVariable); };
        if (std::ranges::none_of(entries_, said)) entries_.push_back(threads_.data());
        entries_.push_back(nullptr);
    }
    char* const* data() const { return entries_.data(); }

  private:
    std::string threads_;
    std::vector<char*> entries_;
};

[[noreturn]] void fail(int error) {
    throw std::runtime_error(std::string("no process for drawing can be started: ") + std::strerror(error));
}

// A process that nobody talks to any more ends within this, or is killed. One that was killed may not end for longer,
// as where a debugger holds it: it can do no more harm, and is not waited for.
constexpr auto kMoment = 1s;

/// Whether it ends within a moment.
bool ends(pid_t process, int& status) {
    const auto limit = Clock::now() + kMoment;
    for (auto pause = 100us;; pause *= 2) {
        if (waitpid(process, &status, WNOHANG) != 0) return true;
        if (Clock::now() > limit) return false;
        std::this_thread::sleep_for(pause);
    }
}

}  // namespace

DrawingProcess::DrawingProcess(int threads, DrawingTerms terms) : threads_(threads), terms_(std::move(terms)) {}

DrawingProcess::~DrawingProcess() {
    if (channel_) end(false);
}

void DrawingProcess::start() {
    if (channel_) return;
    std::erase_if(unburied_, [](pid_t each) { return waitpid(each, nullptr, WNOHANG) != 0; });
    int sockets[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0) fail(errno);
    channel_ = std::make_unique<DrawingChannel>(sockets[0]);
    const DrawingChannel theirs(sockets[1]);

    // The server's other files are none of its business: connections would stay open for as long as it lives.
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, sockets[1], kDrawingSocket);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addclosefrom_np(&files, kDrawingSocket + 1);
    const Environment environment(threads_);
    std::string name = "oval4d", command = kDrawingCommand;
    char* const words[] = {name.data(), command.data(), nullptr};
    const int error = posix_spawn(&process_, "/proc/self/exe", &files, nullptr, words, environment.data());
    posix_spawn_file_actions_destroy(&files);
    if (error == 0) return;
    channel_.reset();
    fail(error);
}

/// Ends it: as it stands, or when it has had a moment to end by itself. Returns how that was.
std::string DrawingProcess::end(bool atOnce) {
    channel_.reset();
    ready_ = false;
    int status = 0;
    if (atOnce || !ends(process_, status)) {
        kill(process_, SIGKILL);
        if (!ends(process_, status)) unburied_.push_back(process_);
    }
    return WIFSIGNALED(status) ? "signal " + std::to_string(WTERMSIG(status))
                               : "status " + std::to_string(WEXITSTATUS(status));
}

Patience DrawingProcess::patience(const std::stop_token& stop) const {
    return {Clock::now() + std::chrono::duration_cast<Clock::duration>(terms_.timeout), stop};
}

/// Carries out `talk` with a process that is ready. It may have been lost before, of something else; a talk that two
/// are lost at is not tried again.
template <typename Talk>
void DrawingProcess::attempt(const std::stop_token& stop, Talk talk) {
    Loss loss;
    for (int losses = 0; losses < 2; ++losses) {
        start();
        Passage passage = Passage::whole;
        try {
            if (!ready_) {
                passage = listen(Said::ready, nullptr, patience(stop));
                if (passage == Passage::whole && said_ == Said::failed) throw std::runtime_error(body_);
                ready_ = passage == Passage::whole;
            }
            if (ready_) passage = talk(patience(stop));
        } catch (...) {
            end(true);  // what it has yet to say would be taken for an answer to what it is asked next
            throw;
        }
        if (passage == Passage::whole) return;
        const std::string how = end(passage == Passage::late);
        if (stop.stop_requested()) throw GivenUp();
        loss = passage == Passage::closed
                   ? Loss{false, "died: " + how}
                   : Loss{true, "hung: no answer in " + protocol::shortest(terms_.timeout.count()) + " s"};
        terms_.onLoss(loss);
    }
    throw std::runtime_error("two processes were lost at this, the second " + loss.how);
}

/// Until it says what is wanted, or why it has failed: see `said_`.
Passage DrawingProcess::listen(Said wanted, const session::State* state, const Patience& patience) {
    for (;;) {
        Passage passage = channel_->receive(said_, body_, nullptr, patience);
        if (passage != Passage::whole || said_ == wanted || said_ == Said::failed) return passage;
        if (said_ != Said::polytope_missing || state == nullptr)
            throw std::runtime_error("a process that draws speaks out of turn");
        std::string polytope;  // large, and seldom wanted
        encodePolytope(*state->polytope, polytope);
        passage = channel_->send(Said::polytope, polytope, DrawingChannel::kNoFile, patience);
        if (passage != Passage::whole) return passage;
    }
}

void DrawingProcess::warmUp(const std::stop_token& stop) {
    attempt(stop, [](const Patience&) { return Passage::whole; });
}

std::span<const std::uint8_t> DrawingProcess::draw(const session::State& state, scene::Viewport viewport,
                                                   SharedPixels& pixels, Times& times, const std::stop_token& stop) {
    encodeOrder(state, viewport, terms_.limits, order_);
    const auto drawn = pixels.take(render::bytesOf(viewport));
    attempt(stop, [&](const Patience& patience) {
        const Passage sent = channel_->send(Said::order, order_, pixels.file(), patience);
        return sent == Passage::whole ? listen(Said::drawn, &state, patience) : sent;
    });
    if (said_ == Said::failed) throw std::runtime_error(body_);
    if (body_.size() != sizeof times) throw std::runtime_error("a message between processes is cut short");
    std::memcpy(&times, body_.data(), sizeof times);
    return drawn;
}

}  // namespace oval4d::picture
