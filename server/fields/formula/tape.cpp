#include "fields/formula/tape.hpp"

#include <utility>

namespace oval4d::fields {

namespace {

using Node = OperationGraph::Node;
using NodeIndex = OperationGraph::NodeIndex;
using OperandForm = Instruction::OperandForm;

constexpr NodeIndex kNever = 0xFFFFFFFF;

bool isLeaf(const Node& node) { return node.operation == Operation::constant || node.operation == Operation::variable; }

class TapeCompiler {
  public:
    TapeCompiler(const OperationGraph& graph, NodeIndex result)
        : nodes_(graph.nodes()),
          result_(result),
          lastUse_(result + 1, kNever),
          registers_(result + 1),
          axes_(result + 1) {
        findLastUses();
        for (NodeIndex node = 0; node <= result_; ++node) {
            if (nodes_[node].operation == Operation::variable) {
                registers_[node] = static_cast<std::uint16_t>(nodes_[node].number);
                axes_[node] = static_cast<Instruction::AxisSet>(1U << registers_[node]);
            } else if (lastUse_[node] != kNever && !isLeaf(nodes_[node])) {
                emitInstruction(node);
            }
        }
        if (isLeaf(nodes_[result_])) emitLeaf(nodes_[result_]);
    }

    Tape takeTape() { return std::move(tape_); }

  private:
    // Sets lastUse_ of each node to the last node that has this node as an operand. lastUse_ remains kNever for a node
    // on which the result does not depend. The last use of the result is the result itself.
    void findLastUses() {
        lastUse_[result_] = result_;
        for (NodeIndex user = result_ + 1; user-- > 0;) {
            if (lastUse_[user] == kNever || isLeaf(nodes_[user])) continue;
            forEachOperand(nodes_[user], [&](NodeIndex operand) {
                if (lastUse_[operand] == kNever) lastUse_[operand] = user;
            });
        }
    }
    template <typename F>
    static void forEachOperand(const Node& node, F&& call) {
        call(node.a);
        if (isBinary(node.operation)) call(node.b);
    }
    bool isConstant(NodeIndex node) const { return nodes_[node].operation == Operation::constant; }

    void emitInstruction(NodeIndex number) {
        const Node& node = nodes_[number];
        Instruction instruction{.operation = node.operation};
        instruction.number = node.number;
        instruction.a = registers_[node.a];
        instruction.axesOfA = axes_[node.a];
        if (isBinary(node.operation)) {
            instruction.b = registers_[node.b];
            instruction.axesOfB = axes_[node.b];
            if (isConstant(node.a)) instruction.form = OperandForm::number_and_register;
            if (isConstant(node.b)) instruction.form = OperandForm::register_and_number;
            if (instruction.form != OperandForm::two_registers)
                instruction.number = nodes_[isConstant(node.a) ? node.a : node.b].number;
        }
        if (!isPiecewiseConstant(node.operation))
            instruction.axes = static_cast<Instruction::AxisSet>(instruction.axesOfA | instruction.axesOfB);
        forEachOperand(node, [&](NodeIndex operand) { releaseRegister(operand, number); });
        instruction.result = number == result_ ? Tape::kResult : allocateRegister();
        registers_[number] = instruction.result;
        axes_[number] = instruction.axes;
        tape_.instructions.push_back(instruction);
    }
    void emitLeaf(const Node& node) {
        Instruction instruction{.operation = node.operation};
        instruction.number = node.number;
        instruction.result = Tape::kResult;
        if (node.operation == Operation::variable) {
            instruction.operation = Operation::copy;
            instruction.a = registers_[result_];
            instruction.axes = instruction.axesOfA = axes_[result_];
        }
        tape_.instructions.push_back(instruction);
    }
    static bool isPiecewiseConstant(Operation operation) {
        return operation == Operation::step || operation == Operation::sign || operation == Operation::floor;
    }
    void releaseRegister(NodeIndex operand, NodeIndex user) {
        if (lastUse_[operand] != user || isLeaf(nodes_[operand])) return;
        free_.push_back(registers_[operand]);
        lastUse_[operand] = kNever;  // prevents a second release if both operands are the same node
    }
    std::uint16_t allocateRegister() {
        if (free_.empty()) return static_cast<std::uint16_t>(Tape::kFirstScratch + tape_.scratchRegisters++);
        const std::uint16_t reused = free_.back();
        free_.pop_back();
        return reused;
    }

    const std::vector<Node>& nodes_;
    NodeIndex result_;
    std::vector<NodeIndex> lastUse_;
    std::vector<std::uint16_t> registers_;
    std::vector<Instruction::AxisSet> axes_;
    std::vector<std::uint16_t> free_;
    Tape tape_;
};

}  // namespace

Tape compileTape(const OperationGraph& graph, OperationGraph::NodeIndex result) {
    return TapeCompiler(graph, result).takeTape();
}

}  // namespace oval4d::fields
