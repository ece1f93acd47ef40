// A task on the socket between the library and its mesher: a packet of one byte that carries two open files.
#pragma once

#include <array>
#include <cstring>
#include <optional>

#include <sys/socket.h>
#include <sys/uio.h>

namespace matstruct::mesher {

/// File descriptors: of the request, to be read, and of the answer, to be written.
struct Files {
  int in = -1, out = -1;
};

/// The message with its buffers. It refers to itself: not to be copied.
struct FilePacket {
  char nothing = 0;
  iovec data{&nothing, 1};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(2 * sizeof(int))> buffer{};
  msghdr message{};

  FilePacket() {
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = buffer.data();
    message.msg_controllen = buffer.size();
  }
  FilePacket(const FilePacket&) = delete;
};

/// Returns whether the other end could be reached.
inline bool send_files(int socket, const Files& files) {
  FilePacket packet;
  cmsghdr* header = CMSG_FIRSTHDR(&packet.message);
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(2 * sizeof(int));
  const std::array<int, 2> both{files.in, files.out};
  std::memcpy(CMSG_DATA(header), both.data(), sizeof both);
  return sendmsg(socket, &packet.message, MSG_NOSIGNAL) == 1;
}

/// Waits for a packet; nothing if the other end is gone.
inline std::optional<Files> receive_files(int socket) {
  FilePacket packet;
  if (recvmsg(socket, &packet.message, MSG_CMSG_CLOEXEC) != 1) return std::nullopt;
  const cmsghdr* header = CMSG_FIRSTHDR(&packet.message);
  if (!header || header->cmsg_type != SCM_RIGHTS || header->cmsg_len != CMSG_LEN(2 * sizeof(int))) return std::nullopt;
  std::array<int, 2> both{};
  std::memcpy(both.data(), CMSG_DATA(header), sizeof both);
  return Files{both[0], both[1]};
}

}  // namespace matstruct::mesher
