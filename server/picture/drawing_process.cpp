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
#include <utility>

namespace oval4d::picture {

namespace {

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

}  // namespace

DrawingProcess::DrawingProcess(int threads, DrawingLimits limits, OnDeath died)
    : threads_(threads), limits_(limits), died_(std::move(died)) {
    start();
}

DrawingProcess::~DrawingProcess() {
    if (channel_) bury();
}

void DrawingProcess::start() {
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

/// Waits for the process's end, which is near.
void DrawingProcess::bury() {
    channel_.reset();
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    end_ = WIFSIGNALED(status) ? "signal " + std::to_string(WTERMSIG(status))
                               : "status " + std::to_string(WEXITSTATUS(status));
}

void DrawingProcess::warmUp() {
    if (!channel_) start();
    if (!listen(Said::ready, nullptr)) throw std::runtime_error("a process that was to draw has died: " + end_);
}

std::span<const std::uint8_t> DrawingProcess::draw(const session::State& state, scene::Viewport viewport,
                                                   SharedPixels& pixels, Times& times) {
    encodeOrder(state, viewport, limits_, order_);
    const auto drawn = pixels.take(render::bytesOf(viewport));
    // It may have died before, of something else; a picture that kills it twice is not tried again.
    for (int deaths = 0; deaths < 2; ++deaths) {
        if (!channel_) start();
        channel_->send(Said::order, order_, pixels.file());
        if (!listen(Said::drawn, &state)) continue;
        if (body_.size() != sizeof times) throw std::runtime_error("a message between processes is cut short");
        std::memcpy(&times, body_.data(), sizeof times);
        return drawn;
    }
    throw std::runtime_error("the process that drew this picture died of it: " + end_);
}

/// Until it says what is wanted; false if it dies.
bool DrawingProcess::listen(Said wanted, const session::State* state) {
    Said said{};
    for (int file = DrawingChannel::kNoFile; channel_->receive(said, body_, file);) {
        if (said == wanted) return true;
        if (said == Said::failed) throw std::runtime_error(body_);
        if (said == Said::polytope_missing) {
            encodePolytope(*state->polytope, body_);
            channel_->send(Said::polytope, body_);
        }
    }
    bury();
    died_(end_);
    return false;
}

}  // namespace oval4d::picture
