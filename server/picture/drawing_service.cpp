// A drawing process, from within.

#include <sys/prctl.h>

#include <algorithm>
#include <csignal>
#include <list>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "picture/drawing_process.hpp"

namespace oval4d::picture {

namespace {

/// The polytopes that were drawn last, the last one first.
class Recent {
  public:
    session::PolytopePtr find(std::uint64_t serial) {
        const auto found = std::ranges::find(kept_, serial, [](const Kept& kept) { return kept.polytope->serial; });
        if (found == kept_.end()) return nullptr;
        kept_.splice(kept_.begin(), kept_, found);
        return found->polytope;
    }
    void add(session::PolytopePtr polytope, std::size_t bytes) {
        kept_.push_front({std::move(polytope), bytes});
        bytes_ += bytes;
    }
    void shrink(std::size_t bytes) {
        for (; bytes_ > bytes && kept_.size() > 1; kept_.pop_back()) bytes_ -= kept_.back().bytes;
    }

  private:
    struct Kept {
        session::PolytopePtr polytope;
        std::size_t bytes;
    };
    std::list<Kept> kept_;
    std::size_t bytes_ = 0;
};

class Service {
  public:
    explicit Service(int socket) : channel_(socket) {}

    void run() {
        if (!attempt([this] { painter_.warmUp(); })) return;
        channel_.send(Said::ready);
        for (Said said{}; next(said);) {
            if (said == Said::order) decodeOrder(body_, order_);
            if (said == Said::polytope) takePolytope();
            order_.state.polytope = recent_.find(order_.polytope);
            if (order_.state.polytope) {
                attempt([this] { draw(); });
            } else {
                channel_.send(Said::polytope_missing);
            }
        }
    }

  private:
    /// After a burst, memory goes back to the system.
    bool next(Said& said) {
        if (!channel_.wait({Patience::Clock::now() + Painter::kPause, {}})) painter_.forget();
        int file = DrawingChannel::kNoFile;
        if (channel_.receive(said, body_, &file) != Passage::whole) return false;
        if (said != Said::order) return true;
        // The system drops a file that this process has no room for.
        if (file == DrawingChannel::kNoFile) throw std::runtime_error("an order came without pixels to draw into");
        auto pixels = std::make_unique<SharedPixels>(file);
        pixels_ = pixels->number();
        files_.try_emplace(pixels_, std::move(pixels));
        return true;
    }

    void takePolytope() {
        auto polytope = std::make_shared<geometry::Polytope>();
        const std::string bytes = std::exchange(body_, {});
        decodePolytope(bytes, *polytope);
        recent_.add(std::move(polytope), bytes.size());
        recent_.shrink(order_.limits.polytopeBytes);
    }

    void draw() {
        painter_.limitFill(order_.limits.fillSteps);
        painter_.draw(order_.state, order_.viewport, files_.at(pixels_)->see(render::bytesOf(order_.viewport)));
        const Times& times = painter_.times();
        channel_.send(Said::drawn, {reinterpret_cast<const char*>(&times), sizeof times});
    }

    template <typename Act>
    bool attempt(Act act) {
        try {
            act();
            return true;
        } catch (const std::exception& fault) {
            channel_.send(Said::failed, fault.what());
            return false;
        }
    }

    DrawingChannel channel_;
    Painter painter_;
    Recent recent_;
    Order order_;
    std::map<std::uint64_t, std::unique_ptr<SharedPixels>> files_;  // one for each worker of the server
    std::uint64_t pixels_ = 0;                                      // the file to draw into
    std::string body_;
};

}  // namespace

void serveDrawing(int socket) {
    // It is for the server to say when to end, though these come to all processes of a terminal or a container.
    std::signal(SIGINT, SIG_IGN);
    std::signal(SIGTERM, SIG_IGN);
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // one that hangs or is stopped does not find its socket closed
    Service(socket).run();
}

}  // namespace oval4d::picture
