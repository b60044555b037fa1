#pragma once
// A Redis server for the tests of session stores.

#include <hiredis/hiredis.h>
#include <netinet/in.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hang_limit.hpp"
#include "store/redis_store.hpp"
#include "unit/store/temporary_folder.hpp"

namespace oval4d::store {

/// A free port that no other program takes. The port is bound to a socket that does not listen, so the system gives it
/// to no other program that asks for a free port. Programs that set SO_REUSEADDR, such as Redis, can still listen on
/// it.
class Port {
  public:
    Port() : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        const int on = 1;
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        auto* const generic = reinterpret_cast<sockaddr*>(&address);
        if (setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 || bind(socket_, generic, size) != 0 ||
            getsockname(socket_, generic, &size) != 0)
            throw std::runtime_error("no port is free");
        number = ntohs(address.sin_port);
    }
    Port(const Port&) = delete;
    Port& operator=(const Port&) = delete;
    ~Port() { close(socket_); }
    int number = 0;

  private:
    int socket_;
};

/// A redis-server process for one test.
class Redis {
  public:
    Redis() { start(); }
    Redis(const Redis&) = delete;
    Redis& operator=(const Redis&) = delete;
    ~Redis() { stop(); }

    void start() {
        std::string text = std::to_string(port_.number), folder = folder_.path;
        std::vector<std::string> words{
            "redis-server", "--port", text,        "--bind",        "127.0.0.1",   "--save", "",
            "--dir",        folder,   "--logfile", folder + "/log", "--maxmemory", "100mb"};
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        if (posix_spawnp(&process_, "redis-server", nullptr, nullptr, arguments.data(), environ) != 0) process_ = 0;
    }
    void stop() {
        if (process_ == 0) return;
        kill(process_, SIGKILL);
        waitpid(std::exchange(process_, 0), nullptr, 0);
    }

    /// Returns a store that is connected to this Redis server, or null if connecting fails.
    std::unique_ptr<Store> connect(Milliseconds expiry = std::chrono::hours(1),
                                   ClockFunction<RedisStore::Clock> now = RedisStore::Clock::now) const {
        StoreOptions options;
        options.url = "redis://127.0.0.1:" + std::to_string(port_.number);
        options.expiry = expiry;
        options.timeout = support::hangLimit();
        auto store = std::make_unique<RedisStore>(options, std::move(now));
        const auto answers = [&] {
            try {
                store->pollTakenOverSessions();
                return true;
            } catch (const StoreError&) {
                return false;
            }
        };
        return process_ != 0 && support::eventually(answers) ? std::move(store) : nullptr;
    }

    /// Returns the time until Redis deletes a key. Returns a negative number if Redis never deletes the key, or has no
    /// such key.
    Milliseconds expiryOf(const std::string& key) const {
        const std::unique_ptr<redisContext, decltype(&redisFree)> context(redisConnect("127.0.0.1", port_.number),
                                                                          redisFree);
        const std::unique_ptr<redisReply, decltype(&freeReplyObject)> reply(
            static_cast<redisReply*>(redisCommand(context.get(), "PTTL %s", key.c_str())), freeReplyObject);
        return Milliseconds(reply ? reply->integer : -1);
    }

    /// Returns whether the Redis hash `key` has the field `field`.
    bool hasField(const std::string& key, const std::string& field) const {
        const std::unique_ptr<redisContext, decltype(&redisFree)> context(redisConnect("127.0.0.1", port_.number),
                                                                          redisFree);
        const std::unique_ptr<redisReply, decltype(&freeReplyObject)> reply(
            static_cast<redisReply*>(redisCommand(context.get(), "HEXISTS %s %s", key.c_str(), field.c_str())),
            freeReplyObject);
        return reply && reply->integer == 1;
    }
    /// Loads a Lua script into Redis, as oval4d servers do.
    void loadScript(const std::string& script) const {
        const std::unique_ptr<redisContext, decltype(&redisFree)> context(redisConnect("127.0.0.1", port_.number),
                                                                          redisFree);
        freeReplyObject(redisCommand(context.get(), "SCRIPT LOAD %s", script.c_str()));
    }

    /// Makes Redis execute a command.
    void execute(const char* command) const {
        const std::unique_ptr<redisContext, decltype(&redisFree)> context(redisConnect("127.0.0.1", port_.number),
                                                                          redisFree);
        freeReplyObject(redisCommand(context.get(), command));
    }

  private:
    const Folder folder_;
    const Port port_;
    pid_t process_ = 0;
};

}  // namespace oval4d::store
