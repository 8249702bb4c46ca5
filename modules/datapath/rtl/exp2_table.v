// Coefficients of 2^rest (kExp2Parabolas in algorithm/splat/exp2.h): of rest^0 23 digits, of rest 23
// and of its square 16, each without what all rows share.
module exp2_table (
    input [5:0] row,
    output [31:0] constant,
    output [31:0] linear,
    output [31:0] square
);
  reg [61:0] coefficients;
  assign constant = {9'h07F, coefficients[61:39]};
  assign linear = {8'h3F, coefficients[38:16], 1'b0};
  assign square = {8'h3E, coefficients[15:0], 8'b0};
  always @* begin
    case (row)
      6'd0: coefficients = 62'h18B92275FE;
      6'd1: coefficients = 62'hB26919B07678AC;
      6'd2: coefficients = 62'h166C39AAA7C7B60;
      6'd3: coefficients = 62'h21D149BA73A7E1E;
      6'd4: coefficients = 62'h2D5619CA6BA8071;
      6'd5: coefficients = 62'h38FB11DA90281D7;
      6'd6: coefficients = 62'h44C079EAE1A8341;
      6'd7: coefficients = 62'h50A6A9FB60884AF;
      6'd8: coefficients = 62'h5CAE120C0D88621;
      6'd9: coefficients = 62'h68D6FA1CE908797;
      6'd10: coefficients = 62'h7521D22DF368911;
      6'd11: coefficients = 62'h818EE23F2D68A8F;
      6'd12: coefficients = 62'h8E1E9A509748C11;
      6'd13: coefficients = 62'h9AD15A6231C8D97;
      6'd14: coefficients = 62'hA7A78273FD68F22;
      6'd15: coefficients = 62'hB4A16A85FA890B1;
      6'd16: coefficients = 62'hC1BF829829E9245;
      6'd17: coefficients = 62'hCF0232AA8BE93DC;
      6'd18: coefficients = 62'hDC69D2BD2129578;
      6'd19: coefficients = 62'hE9F6D2CFEA49719;
      6'd20: coefficients = 62'hF7A992E2E7A98BE;
      6'd21: coefficients = 62'h105828AF61A09A68;
      6'd22: coefficients = 62'h113821B0981E9C17;
      6'd23: coefficients = 62'h121A8B31D1FE9DCA;
      6'd24: coefficients = 62'h12FF6BB30F4A9F82;
      6'd25: coefficients = 62'h13E6CA345008A13E;
      6'd26: coefficients = 62'h14D0ADB59446A300;
      6'd27: coefficients = 62'h15BD1D36DC0AA4C6;
      6'd28: coefficients = 62'h16AC1FB82762A691;
      6'd29: coefficients = 62'h179DBCB97654A862;
      6'd30: coefficients = 62'h1891FB3AC8ECAA37;
      6'd31: coefficients = 62'h1988E23C1F36AC12;
      6'd32: coefficients = 62'h1A8279BD7938ADF1;
      6'd33: coefficients = 62'h1B7EC93ED6FEAFD6;
      6'd34: coefficients = 62'h1C7DD7C01C4AB1C0;
      6'd35: coefficients = 62'h1D7FADC0CF02B3B0;
      6'd36: coefficients = 62'h1E84524183ACB5A5;
      6'd37: coefficients = 62'h1F8BCD423A4EB79F;
      6'd38: coefficients = 62'h209626C2F2EDB99F;
      6'd39: coefficients = 62'h21A366C3AD8EBBA4;
      6'd40: coefficients = 62'h22B395446A38BDB0;
      6'd41: coefficients = 62'h23C6BAC528EFBFC0;
      6'd42: coefficients = 62'h24DCDF45E9BBC1D7;
      6'd43: coefficients = 62'h25F60AC6AC9FC3F3;
      6'd44: coefficients = 62'h2712464771A3C615;
      6'd45: coefficients = 62'h28319A4838CDC83E;
      6'd46: coefficients = 62'h29540F490221CA6C;
      6'd47: coefficients = 62'h2A79ADC9CDA7CCA0;
      6'd48: coefficients = 62'h2BA27ECA9B64CEDB;
      6'd49: coefficients = 62'h2CCE8B4B6B5ED11B;
      6'd50: coefficients = 62'h2DFDDC4C3D9DD362;
      6'd51: coefficients = 62'h2F307ACD1225D5AF;
      6'd52: coefficients = 62'h30666FCDE8FED803;
      6'd53: coefficients = 62'h319FC4CEC22EDA5D;
      6'd54: coefficients = 62'h32DC83CF9DBBDCBE;
      6'd55: coefficients = 62'h341CB5507BACDF25;
      6'd56: coefficients = 62'h356063D15C08E193;
      6'd57: coefficients = 62'h36A798523ED6E408;
      6'd58: coefficients = 62'h37F25D53241BE684;
      6'd59: coefficients = 62'h3940BBD40BE0E906;
      6'd60: coefficients = 62'h3A92BED4F62BEB90;
      6'd61: coefficients = 62'h3BE86FD5E303EE21;
      6'd62: coefficients = 62'h3D41D9D6D26FF0B9;
      default: coefficients = 62'h3E9F0657C477F358;
    endcase
  end
endmodule
